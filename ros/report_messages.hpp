#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include "geometry/camera.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/engine_runner.hpp"
#include "ros/node_config.hpp"
#include "ros/topic_reader.hpp"

/// From the engine's results to ROS messages: pure functions. Stamps are the image's.
namespace alight {

/// 32FC1, metres along the optical axis (REP-118), NaN where unknown; all of it in an image without trusted depth.
sensor_msgs::Image depth_image(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                               const FrameNames& names);
/// Of the depth image: rectified and cropped, so that K is P and there is no distortion.
sensor_msgs::CameraInfo camera_info(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                                    const FrameNames& names);
/// x y z rgb of every `step_px`-th pixel with a depth, in the camera's frame.
sensor_msgs::PointCloud2 points(const FrameReport& frame, const PinholeIntrinsics& intrinsics, int step_px,
                                const FrameNames& names);
/// mono8 in the level camera's image, 255 = safe to land on; nothing is in an image without trusted depth.
sensor_msgs::Image safe_mask(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                             const FrameNames& names);
/// The place of a site in the map, unturned.
geometry_msgs::PoseStamped landing_site(const FrameReport& frame, const TrackedSite& site,
                                        const FrameNames& names);
/// A circle around the site, green once it is accepted, yellow before; DELETE where there is no site.
visualization_msgs::Marker landing_site_marker(const FrameReport& frame, const FrameNames& names);
/// map -> camera -> level camera; empty for an image without pose.
tf2_msgs::TFMessage transforms(const FrameReport& frame, const FrameNames& names);

/// What the sensors' health says.
diagnostic_msgs::DiagnosticStatus sensor_status(const std::string& node, const HealthReport& health);
/// Whether the topics deliver.
diagnostic_msgs::DiagnosticStatus topic_status(const std::string& node,
                                               const std::vector<TopicState>& topics);
/// Sum of the counts of reasons.
std::int64_t total(const std::map<std::string, std::int64_t>& counts);
/// Whether the engine keeps up. @param last null: no result yet. @param dropped_before total() of the statistics' dropped
/// when this was asked before: only new losses are a warning
diagnostic_msgs::DiagnosticStatus engine_status(const std::string& node, const RunnerStatistics& statistics,
                                                const std::map<std::string, std::int64_t>& not_read,
                                                const FrameReport* last, std::int64_t dropped_before);

}  // namespace alight
