#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/sensors/sensor_config.hpp"

namespace alight::sim {

/// How far each fix of a flight is off, but for its white noise: 0 at the first fix, each axis of its own. Both kinds are
/// sampled exactly at the fixes' times, whatever the rate.
///   rough   Ornstein-Uhlenbeck: correlation exp(-t / drift_time_s). Its steps grow with the square root of time,
///           drift_m sqrt(2 t / drift_time_s) in a short time t: 5 cm in a second with the defaults.
///   smooth  second-order Gauss-Markov, critically damped (Gelb, Applied Optimal Estimation, ch. 2): correlation
///           (1 + b t) exp(-b t) with b so that it has fallen to 1/e after drift_time_s. The drift has a velocity, whose
///           1 sigma is b drift_m, 1.1 cm/s with the defaults, and which is drawn for the first fix.
std::vector<Eigen::Vector3d> gps_drift(const GpsConfig& config, double duration_s, std::uint64_t seed);

/// b of the smooth drift, 1/s.
double smooth_drift_rate_per_s(const GpsConfig& config);

}  // namespace alight::sim
