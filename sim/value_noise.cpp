#include "sim/value_noise.hpp"

#include <cmath>

#include "sim/random.hpp"

namespace alight::sim {
namespace {

double knot(std::int64_t x, std::int64_t y, std::uint32_t seed) {
  const std::uint32_t bits =
      mix_bits(static_cast<std::uint32_t>(x), mix_bits(static_cast<std::uint32_t>(y), seed));
  return bits * 0x1p-31 - 1.0;
}

// Quintic: second derivatives are continuous, so slopes have no creases at the knots.
double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

double value_noise(double x, double y, std::uint32_t seed) {
  const double x0 = std::floor(x);
  const double y0 = std::floor(y);
  const auto ix = static_cast<std::int64_t>(x0);
  const auto iy = static_cast<std::int64_t>(y0);
  const double tx = fade(x - x0);
  const double ty = fade(y - y0);
  const double low = knot(ix, iy, seed) * (1 - tx) + knot(ix + 1, iy, seed) * tx;
  const double high = knot(ix, iy + 1, seed) * (1 - tx) + knot(ix + 1, iy + 1, seed) * tx;
  return low * (1 - ty) + high * ty;
}

}  // namespace alight::sim
