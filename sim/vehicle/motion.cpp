#include "sim/vehicle/motion.hpp"

#include <cmath>

namespace alight::sim {

Eigen::Matrix3d attitude_of_thrust(const Eigen::Vector3d& thrust_mps2, double yaw_rad) {
  const Eigen::Vector3d heading(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  Eigen::Matrix3d R_world_imu;
  R_world_imu.col(2) = thrust_mps2.normalized();
  R_world_imu.col(1) = R_world_imu.col(2).cross(heading).normalized();
  R_world_imu.col(0) = R_world_imu.col(1).cross(R_world_imu.col(2));
  return R_world_imu;
}

Eigen::Vector3d angular_velocity_radps(const Eigen::Matrix3d& R_world_before,
                                       const Eigen::Matrix3d& R_world_after, double between_s) {
  const Eigen::Matrix3d turn = R_world_before.transpose() * R_world_after;
  const Eigen::AngleAxisd rotation(turn);
  return rotation.axis() * (rotation.angle() / between_s);
}

}  // namespace alight::sim
