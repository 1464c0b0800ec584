#pragma once

#include <cstdint>

namespace alight {

/// Where a draw stands in a run. The same numbers draw the same, whatever was drawn before, so that a run that is
/// resumed or shared by several processes draws what an undivided one does.
struct DrawKey {
  std::uint64_t seed = 0;
  std::int64_t step = 0;
  std::int64_t first = 0;  ///< place in the whole batch of the first sample that is given
};

/// A generator's seed for one draw: neighbouring keys give unrelated seeds. @param place in the whole batch, from 1;
/// 0 is the batch itself
std::uint64_t mixed_seed(std::uint64_t seed, std::int64_t step, std::int64_t place);

}  // namespace alight
