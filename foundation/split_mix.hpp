#pragma once

#include <cstdint>

namespace alight {

/// Number `index`, from 0, of the sequence that SplitMix64 (Steele et al. 2014) draws from a seed, without drawing those
/// before it. Neighbouring seeds and neighbouring indices give unrelated numbers.
constexpr std::uint64_t split_mix(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t x = seed + 0x9E3779B97F4A7C15ULL * (index + 1);
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

}  // namespace alight
