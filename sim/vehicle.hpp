#pragma once

#include <Eigen/Geometry>

#include "sim/flight_path.hpp"

namespace alight::sim {

constexpr double kGravity_mps2 = 9.80665;

/// Everything that a sensor on the vehicle can feel.
struct VehicleState {
  Eigen::Isometry3d T_world_imu = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();       ///< world
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();  ///< world, without gravity
  Eigen::Vector3d angular_velocity_imu_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_imu_mps2 = Eigen::Vector3d::Zero();  ///< what an accelerometer reads
};

/// A multirotor on a path: thrust is its only force besides gravity and drag, so roll and pitch follow from
/// the acceleration and the air speed (differential flatness), and yaw is free.
class Vehicle {
 public:
  /// @param drag_per_s deceleration by air drag per unit of velocity (about 0.15 for a DJI M600)
  explicit Vehicle(FlightPath path, double drag_per_s = 0.15);

  const FlightPath& path() const { return path_; }
  double duration_s() const { return path_.duration_s(); }

  Eigen::Isometry3d T_world_imu(double t_s) const;
  VehicleState state(double t_s) const;

 private:
  FlightPath path_;
  double drag_per_s_;
};

}  // namespace alight::sim
