#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "infer/autopilot/mavlink_messages.hpp"
#include "infer/landing/memory/site_tracker.hpp"

namespace alight {

/// A landing site as the autopilot wants it, at the moment of its image: position in MAV_FRAME_BODY_FRD (x forward,
/// y right, z down) from the origin of the `imu` frame; the angles off the optical axis of the rectified left camera,
/// whose x is right and y down; distance_m = |p_m|, by which ArduPilot divides; size_x_rad = size_y_rad, the angle that
/// the safe circle's diameter takes up in the camera's view; orientation: level, the vehicle's heading kept (a circle
/// has none of its own). time_us is t_ns, which is on the clock of the messages' stamps.
/// @param T_world_camera pose of the rectified left camera at t_ns  @param T_camera_imu as RectifiedRig has it
LandingTarget landing_target(const TrackedSite& site, std::int64_t t_ns,
                             const Eigen::Isometry3d& T_world_camera, const Eigen::Isometry3d& T_camera_imu);

}  // namespace alight
