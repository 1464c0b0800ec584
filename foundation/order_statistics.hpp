#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace alight {

/// The value at `place`, counted from 0, of `values` in ascending order, in linear time.
/// @param values more than `place` of them, no NaN; comes back in another order
template <class Value>
Value value_at_place(std::vector<Value>& values, std::size_t place) {
  const auto found = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), found, values.end());
  return *found;
}

/// The median. Of an even count it is the upper of the two middle values and not their mean: the median is then one of
/// the values, of whichever type. @param values at least one, no NaN; comes back in another order
template <class Value>
Value median(std::vector<Value>& values) {
  return value_at_place(values, values.size() / 2);
}
template <class Value>
Value median(std::vector<Value>&& values) {
  return median(values);
}

/// The value at `share` of the way from the least (0) to the greatest (1), its place rounded down: of an even count
/// `quantile(values, 0.5)` is the lower of the two middle values.
/// @param values at least one, no NaN; comes back in another order @param share 0..1
template <class Value>
Value quantile(std::vector<Value>& values, double share) {
  return value_at_place(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

}  // namespace alight
