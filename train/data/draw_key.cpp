#include "train/data/draw_key.hpp"

#include "foundation/split_mix.hpp"

namespace alight {

std::uint64_t mixed_seed(std::uint64_t seed, std::int64_t step, std::int64_t place) {
  return split_mix(split_mix(seed, static_cast<std::uint64_t>(step)), static_cast<std::uint64_t>(place));
}

}  // namespace alight
