#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/geodesy.hpp"
#include "sim/counter_random.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/vehicle/motion.hpp"

namespace alight::sim {

/// What an IMU measures, in its own frame, and the attitude that it estimates.
struct ImuSample {
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_world_imu = Eigen::Quaterniond::Identity();
};

/// A position fix, WGS84.
struct GeodeticFix {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;
};

/// Attitude, IMU, position and height of a flight controller. Sample k of a sensor is taken k / rate after
/// the flight's start. The result depends on the seed and k alone.
class PoseSensors {
 public:
  /// @param ground_m height of the ground at the take-off place, which lies below the flight's first
  /// position. The vehicle must outlive the sensors.
  PoseSensors(const Motion& vehicle, const SensorsConfig& config, std::uint64_t seed, double ground_m);

  Eigen::Quaterniond attitude(std::int64_t k) const;
  ImuSample imu(std::int64_t k) const;
  GeodeticFix position(std::int64_t k) const;
  double height_m(std::int64_t k) const;

 private:
  Eigen::Quaterniond noisy_attitude(double t_s, std::uint64_t counter) const;

  const Motion& vehicle_;
  SensorsConfig config_;
  std::uint64_t seed_;
  Eigen::Vector3d p_home_world_;
  LocalEnu home_;
  std::vector<Eigen::Vector3d> drift_m_;  // of each fix
  Eigen::Vector3d accelerometer_bias_mps2_;
  Eigen::Vector3d gyroscope_bias_radps_;
};

}  // namespace alight::sim
