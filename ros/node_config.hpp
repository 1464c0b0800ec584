#pragma once

#include <string>

#include <ros/node_handle.h>

#include "foundation/binder_fwd.hpp"
#include "infer/onboard/mode_switch.hpp"
#include "infer/replay/replay.hpp"

namespace alight {

/// Names of the coordinate frames in the node's messages (REP-103, REP-105).
struct FrameNames {
  std::string camera =
      "left_camera_optical_frame";                ///< the rectified left camera: x right, y down, z forward
  std::string level = "left_camera_level_frame";  ///< the same place, turned until z points straight down
  std::string map = "map";                        ///< East-North-Up from the first position
};

/// The private parameters of the ROS node.
struct NodeConfig {
  std::string config;      ///< file as configs/infer/*.yaml; empty: the built-in defaults
  std::string rig;         ///< in place of the file's; empty: the file's
  std::string checkpoint;  ///< in place of the file's; empty: the file's
  bool lidar_only = false;
  FlightMode mode = FlightMode::kManual;  ///< at the start
  FrameNames frames;
  int point_step_px = 4;    ///< every so many pixels, in both directions, is a point
  bool publish_tf = false;  ///< map -> camera -> level on /tf
};
void bind(Binder& b, NodeConfig& c);

/// The parameters from the ROS master. @throws ConfigError that names every wrong or unknown one
NodeConfig read_parameters(const ros::NodeHandle& node);

/// The file of `config` with what the parameters put in its place. @throws ConfigError
ReplayConfig resolve(const NodeConfig& config);

}  // namespace alight
