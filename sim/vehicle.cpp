#include "sim/vehicle.hpp"

#include <cmath>
#include <utility>

namespace alight::sim {
namespace {

/// Body z along the thrust, body x as near to the heading as that allows.
Eigen::Matrix3d attitude(const PathPoint& point, double drag_per_s) {
  const Eigen::Vector3d thrust =
      point.acceleration_mps2 + drag_per_s * point.velocity_mps + kGravity_mps2 * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d heading(std::cos(point.yaw_rad), std::sin(point.yaw_rad), 0);
  Eigen::Matrix3d R_world_imu;
  R_world_imu.col(2) = thrust.normalized();
  R_world_imu.col(1) = R_world_imu.col(2).cross(heading).normalized();
  R_world_imu.col(0) = R_world_imu.col(1).cross(R_world_imu.col(2));
  return R_world_imu;
}

}  // namespace

Vehicle::Vehicle(FlightPath path, double drag_per_s) : path_(std::move(path)), drag_per_s_(drag_per_s) {}

Eigen::Isometry3d Vehicle::T_world_imu(double t_s) const {
  const PathPoint point = path_.at(t_s);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = attitude(point, drag_per_s_);
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
  const Eigen::Matrix3d turn =
      T_world_imu(t_s - kStep_s).linear().transpose() * T_world_imu(t_s + kStep_s).linear();
  const Eigen::AngleAxisd rotation(turn);
  state.angular_velocity_imu_radps = rotation.axis() * (rotation.angle() / (2 * kStep_s));
  state.specific_force_imu_mps2 = state.T_world_imu.linear().transpose() *
                                  (point.acceleration_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ());
  return state;
}

}  // namespace alight::sim
