#pragma once

#include <cstdint>

#include "geometry/rig/stereo_rectification.hpp"
#include "infer/depth/landing_pipeline.hpp"

/// Results with a known landing site.
namespace alight::reports {

constexpr std::int64_t kStart_ns = 1'600'000'000'123'456'789;

/// Looks down, image up = vehicle forward, mounted off the body's origin.
inline RectifiedRig down_looking_rig(const Eigen::Vector3d& t_camera_imu = {0.04, 0.10, -0.12}) {
  RectifiedRig rig;
  rig.T_camera_imu.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  rig.T_camera_imu.translation() = t_camera_imu;
  return rig;
}

/// A level vehicle 12 m over a confirmed site of 3 m, which lies 3 m ahead and 2 m to the left.
inline FrameReport confirmed(std::int64_t t_ns = kStart_ns) {
  Eigen::Isometry3d T_world_imu = Eigen::Isometry3d::Identity();
  T_world_imu.translation() = Eigen::Vector3d(10, 20, 30);
  FrameReport frame;
  frame.depth.t_ns = t_ns;
  frame.depth.source = DepthSource::kLidar;
  frame.depth.T_world_camera = T_world_imu * down_looking_rig().T_camera_imu.inverse();
  TrackedSite site;
  site.circle.radius_m = 3;
  site.p_world = T_world_imu * Eigen::Vector3d(3, 2, -12);
  site.frames = 5;
  site.accepted = true;
  frame.decision.site = site;
  return frame;
}

}  // namespace alight::reports
