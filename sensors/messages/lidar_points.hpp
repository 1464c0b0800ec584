#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// True for a point that something gave back. "No return" is (0, 0, 0): nearer than any limit.
inline bool is_echo(const Eigen::Vector3f& p_lidar, const DecodeOptions& options) {
  const double range_m = p_lidar.cast<double>().norm();
  return std::isfinite(range_m) && range_m > 0 && range_m >= options.min_range_m &&
         range_m <= options.max_range_m;
}

/// A driver's intensity on the scale 0 .. 255; 0 where it is not finite.
inline std::uint8_t scaled_reflectivity(double intensity, double scale) {
  const double scaled = intensity * scale;
  return std::isfinite(scaled) ? static_cast<std::uint8_t>(std::clamp(scaled, 0.0, 255.0)) : std::uint8_t{0};
}

}  // namespace alight
