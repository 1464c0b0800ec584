#pragma once

#include <Eigen/Geometry>

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

/// How a vehicle moves: what the sensors on it ask. Times from the start of the flight.
class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = default;
  Motion& operator=(const Motion&) = default;
  Motion(Motion&&) = default;
  Motion& operator=(Motion&&) = default;
  virtual ~Motion() = default;

  virtual Eigen::Isometry3d T_world_imu(double t_s) const = 0;
  virtual VehicleState state(double t_s) const = 0;
  /// The longest that the flight can last.
  virtual double duration_s() const = 0;
};

/// Body z along the thrust, body x as near to the heading as that allows: a multirotor's thrust is its only force
/// besides gravity and drag (differential flatness).
/// @param thrust_mps2 thrust over mass, world  @param yaw_rad from east, counter-clockwise
Eigen::Matrix3d attitude_of_thrust(const Eigen::Vector3d& thrust_mps2, double yaw_rad);

/// Angular velocity from `before` to `after`, in the body frame. @param between_s time between them
Eigen::Vector3d angular_velocity_radps(const Eigen::Matrix3d& R_world_before,
                                       const Eigen::Matrix3d& R_world_after, double between_s);

}  // namespace alight::sim
