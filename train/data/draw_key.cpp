#include "train/data/draw_key.hpp"

#include <initializer_list>

namespace alight {

/// SplitMix64 (Steele et al. 2014) over the three numbers.
std::uint64_t mixed_seed(std::uint64_t seed, std::int64_t step, std::int64_t place) {
  std::uint64_t state = seed;
  for (const std::int64_t number : {step, place}) {
    state += 0x9E3779B97F4A7C15ULL * (static_cast<std::uint64_t>(number) + 1);
    state = (state ^ (state >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    state = (state ^ (state >> 27U)) * 0x94D049BB133111EBULL;
    state ^= state >> 31U;
  }
  return state;
}

}  // namespace alight
