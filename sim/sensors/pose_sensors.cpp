#include "sim/sensors/pose_sensors.hpp"

#include "geometry/frames.hpp"
#include "sim/sensors/gps_drift.hpp"

namespace alight::sim {
namespace {

double time_s(std::int64_t k, double rate_hz) {
  return to_seconds(to_nanoseconds(static_cast<double>(k) / rate_hz));
}

std::uint64_t counter(std::int64_t k) { return static_cast<std::uint64_t>(k); }

}  // namespace

PoseSensors::PoseSensors(const Motion& vehicle, const SensorsConfig& config, std::uint64_t seed,
                         double ground_m)
    : vehicle_(vehicle),
      config_(config),
      seed_(seed),
      p_home_world_(vehicle.T_world_imu(0).translation()),
      home_(config.gps.latitude_deg, config.gps.longitude_deg, config.gps.altitude_m),
      drift_m_(gps_drift(config.gps, vehicle.duration_s(), seed)) {
  p_home_world_.z() = ground_m;
  const CounterRandom bias(seed, RandomStream::kImuBias);
  accelerometer_bias_mps2_ = config.imu.accelerometer_bias_mps2 * bias.normal3(0);
  gyroscope_bias_radps_ = config.imu.gyroscope_bias_radps * bias.normal3(1);
}

Eigen::Quaterniond PoseSensors::noisy_attitude(double t_s, std::uint64_t index) const {
  const Eigen::Vector3d error =
      to_radians(config_.attitude.noise_deg) * CounterRandom(seed_, RandomStream::kAttitude).normal3(index);
  const Eigen::Quaterniond small(1.0, 0.5 * error.x(), 0.5 * error.y(), 0.5 * error.z());
  return (Eigen::Quaterniond(vehicle_.T_world_imu(t_s).linear()) * small).normalized();
}

Eigen::Quaterniond PoseSensors::attitude(std::int64_t k) const {
  return noisy_attitude(time_s(k, config_.attitude.rate_hz), counter(k));
}

ImuSample PoseSensors::imu(std::int64_t k) const {
  const double t_s = time_s(k, config_.imu.rate_hz);
  const VehicleState state = vehicle_.state(t_s);
  const CounterRandom accelerometer(seed_, RandomStream::kAccelerometer);
  const CounterRandom gyroscope(seed_, RandomStream::kGyroscope);
  ImuSample sample;
  sample.specific_force_mps2 = state.specific_force_imu_mps2 + accelerometer_bias_mps2_ +
                               config_.imu.accelerometer_noise_mps2 * accelerometer.normal3(counter(k));
  sample.angular_velocity_radps = state.angular_velocity_imu_radps + gyroscope_bias_radps_ +
                                  config_.imu.gyroscope_noise_radps * gyroscope.normal3(counter(k));
  constexpr std::uint64_t kApart = 1ULL << 40;  // keeps its errors apart from those of the attitude messages
  sample.q_world_imu = noisy_attitude(t_s, kApart + counter(k));
  return sample;
}

GeodeticFix PoseSensors::position(std::int64_t k) const {
  const Eigen::Vector3d noise_m =
      config_.gps.noise_m * CounterRandom(seed_, RandomStream::kGpsWhite).normal3(counter(k));
  const Eigen::Vector3d p_world = vehicle_.T_world_imu(time_s(k, config_.gps.rate_hz)).translation();
  const Eigen::Vector3d p_home = p_world - p_home_world_ + drift_m_.at(static_cast<std::size_t>(k)) + noise_m;
  const Eigen::Vector3d geodetic = home_.to_geodetic(p_home);
  return {geodetic.x(), geodetic.y(), geodetic.z()};
}

double PoseSensors::height_m(std::int64_t k) const {
  const double z_m =
      vehicle_.T_world_imu(time_s(k, config_.height.rate_hz)).translation().z() - p_home_world_.z();
  return z_m + config_.height.noise_m * CounterRandom(seed_, RandomStream::kHeight).normal(counter(k));
}

}  // namespace alight::sim
