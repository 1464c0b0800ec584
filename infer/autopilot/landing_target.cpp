#include "infer/autopilot/landing_target.hpp"

#include <cmath>

namespace alight {
namespace {

/// From x forward, y left, z up to x forward, y right, z down.
Eigen::Vector3d frd_from_flu(const Eigen::Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }

float rounded(double value) { return static_cast<float>(value); }

}  // namespace

LandingTarget landing_target(const TrackedSite& site, std::int64_t t_ns,
                             const Eigen::Isometry3d& T_world_camera, const Eigen::Isometry3d& T_camera_imu) {
  const Eigen::Isometry3d T_world_imu = T_world_camera * T_camera_imu;
  const Eigen::Vector3d p_camera = T_world_camera.inverse() * site.p_world;
  const Eigen::Vector3d p_frd = frd_from_flu(T_world_imu.inverse() * site.p_world);
  const Eigen::Vector3d down_frd = frd_from_flu(T_world_imu.linear().transpose() * -Eigen::Vector3d::UnitZ());
  const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), down_frd);

  LandingTarget target;
  target.time_us = static_cast<std::uint64_t>(t_ns / 1000);
  target.angle_x_rad = rounded(std::atan2(p_camera.x(), p_camera.z()));
  target.angle_y_rad = rounded(std::atan2(p_camera.y(), p_camera.z()));
  target.distance_m = rounded(p_frd.norm());
  target.size_x_rad = rounded(2 * std::atan2(site.circle.radius_m, p_camera.norm()));
  target.size_y_rad = target.size_x_rad;
  target.p_m = {rounded(p_frd.x()), rounded(p_frd.y()), rounded(p_frd.z())};
  target.q_wxyz = {rounded(q.w()), rounded(q.x()), rounded(q.y()), rounded(q.z())};
  target.position_valid = 1;
  return target;
}

}  // namespace alight
