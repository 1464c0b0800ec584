#pragma once

#include <string>
#include <vector>

namespace alight {

/// A mark of an axis with its words.
struct AxisTick {
  double value = 0;
  std::string label;
};

/// The range of a chart's axis, in the data's units, and the round numbers on it.
struct ChartAxis {
  double min = 0;
  double max = 1;
  bool logarithmic = false;
  std::vector<AxisTick> ticks;

  /// Where a value lies: 0 at min, 1 at max.
  double share(double value) const;
};

/// An axis from `min` to `max`, both finite, with about five ticks at 1, 2 or 5 times a power of ten; a range of no
/// length is widened. @param whole ticks at whole numbers only
ChartAxis linear_axis(double min, double max, bool whole = false);

/// An axis of factors, a little wider than `min` to `max`. @throws std::invalid_argument unless 0 < min <= max
ChartAxis logarithmic_axis(double min, double max);

/// A number as short as it can be read: 1500, 0.02, 2e-5.
std::string tick_label(double value);

}  // namespace alight
