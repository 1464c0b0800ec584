#include "sim/vehicle/vehicle.hpp"

#include <utility>

namespace alight::sim {
Vehicle::Vehicle(FlightPath path, double drag_per_s) : path_(std::move(path)), drag_per_s_(drag_per_s) {}

Eigen::Isometry3d Vehicle::T_world_imu(double t_s) const {
  const PathPoint point = path_.at(t_s);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = attitude_of_thrust(
      point.acceleration_mps2 + drag_per_s_ * point.velocity_mps + kGravity_mps2 * Eigen::Vector3d::UnitZ(),
      point.yaw_rad);
  T.translation() = point.p_world;
  return T;
}

VehicleState Vehicle::state(double t_s) const {
  constexpr double kStep_s = 1e-4;  // the central difference's error is below 1e-7 rad/s at this step
  const PathPoint point = path_.at(t_s);
  VehicleState state;
  state.T_world_imu = T_world_imu(t_s);
  state.velocity_mps = point.velocity_mps;
  state.acceleration_mps2 = point.acceleration_mps2;
  state.angular_velocity_imu_radps = angular_velocity_radps(T_world_imu(t_s - kStep_s).linear(),
                                                            T_world_imu(t_s + kStep_s).linear(), 2 * kStep_s);
  state.specific_force_imu_mps2 = state.T_world_imu.linear().transpose() *
                                  (point.acceleration_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ());
  return state;
}

}  // namespace alight::sim
