#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace alight::sim {

/// One shot every 10 us: 100,000 points a second.
constexpr std::int64_t kLivoxShotPeriod_ns = 10'000;
/// The rosette closes after 30 s (the prisms' speeds share two revolutions a minute).
constexpr std::int64_t kLivoxPatternShots = 3'000'000;
/// Half of the circular field of view, radians (19.174 deg).
constexpr double kLivoxHalfFov_rad = 0.33465;

/// Unit vector of shot `shot` (counted from power-up, time (shot + 1) * 10 us) in the lidar frame, x forward.
/// A pair of rotating wedge prisms traced by Snell's law (METHOD, "The Livox Mid-40 scan"); reproduces the
/// manufacturer's scan table to 0.001 deg. Any shot >= 0.
Eigen::Vector3d livox_direction(std::int64_t shot);

}  // namespace alight::sim
