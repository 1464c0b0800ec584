#include "sim/sensors/gps_drift.hpp"

#include <algorithm>
#include <cmath>

#include "sim/counter_random.hpp"

namespace alight::sim {
namespace {

using Values = std::vector<Eigen::Vector3d>;

void add_rough(const GpsConfig& config, const CounterRandom& random, Values& values) {
  const double keep = std::exp(-1.0 / (config.rate_hz * config.drift_time_s));
  const double kick_m = config.drift_m * std::sqrt(1.0 - keep * keep);
  for (std::size_t k = 1; k < values.size(); ++k)
    values[k] = keep * values[k - 1] + kick_m * random.normal3(k);
}

/// Position and velocity (v / b, so that both are metres) go on by the matrix exponential of the free motion, plus noise
/// with the covariance that keeps the stationary one.
void add_smooth(const GpsConfig& config, const CounterRandom& random, Values& values) {
  const double step = smooth_drift_rate_per_s(config) / config.rate_hz;
  const double fade = std::exp(-step);
  const double position2 = std::max(0.0, 1 - fade * fade * (1 + 2 * step + 2 * step * step));
  const double velocity2 = std::max(0.0, 1 - fade * fade * (1 - 2 * step + 2 * step * step));
  const double both = 2 * step * step * fade * fade;
  const double kick = std::sqrt(velocity2);
  const double along = kick > 0 ? both / kick : 0;  // Cholesky, velocity first
  const double aside = std::sqrt(std::max(0.0, position2 - along * along));
  Eigen::Vector3d velocity_m = config.drift_m * random.normal3(0);
  for (std::size_t k = 1; k < values.size(); ++k) {
    const Eigen::Vector3d first = config.drift_m * random.normal3(2 * k);
    const Eigen::Vector3d second = config.drift_m * random.normal3(2 * k + 1);
    values[k] = fade * ((1 + step) * values[k - 1] + step * velocity_m) + along * first + aside * second;
    velocity_m = fade * ((1 - step) * velocity_m - step * values[k - 1]) + kick * first;
  }
}

}  // namespace

double smooth_drift_rate_per_s(const GpsConfig& config) {
  constexpr double kFallen = 2.1461932206205825;  // (1 + x) exp(-x) = 1/e
  return kFallen / config.drift_time_s;
}

std::vector<Eigen::Vector3d> gps_drift(const GpsConfig& config, double duration_s, std::uint64_t seed) {
  Values values(static_cast<std::size_t>(std::ceil(duration_s * config.rate_hz)) + 2,
                Eigen::Vector3d::Zero());
  const CounterRandom random(seed, RandomStream::kGpsDrift);
  if (config.drift_kind == DriftKind::kRough) {
    add_rough(config, random, values);
  } else {
    add_smooth(config, random, values);
  }
  return values;
}

}  // namespace alight::sim
