#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/frames.hpp"

namespace alight::sim {

/// A full turn, in radians.
inline constexpr double kTwoPi = 2 * kPi;

/// Bits that look random in all positions (Wellons' "lowbias32" mixer).
constexpr std::uint32_t mix_bits(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7FEB352DU;
  x ^= x >> 15U;
  x *= 0x846CA68BU;
  return x ^ (x >> 16U);
}
constexpr std::uint32_t mix_bits(std::uint32_t a, std::uint32_t b) {
  return mix_bits(a * 0x9E3779B1U + mix_bits(b));
}

/// PCG32 (O'Neill). Ours because the standard library's distributions give other numbers with every library. Draw one
/// number a statement, or within braces: C++ leaves the order of arguments and operands to the compiler.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : increment_((stream << 1U) | 1U) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }
  /// [0, 1)
  double uniform() { return next() * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  float uniformf(double low, double high) { return static_cast<float>(uniform(low, high)); }
  /// 0 .. count - 1
  int below(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }
  /// One of several, of which there has to be one at least.
  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[static_cast<std::size_t>(below(static_cast<int>(from.size())))];
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace alight::sim
