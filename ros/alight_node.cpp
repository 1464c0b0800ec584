#include <exception>
#include <string>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "infer/network/chosen_predictor.hpp"
#include "ros/landing_node.hpp"

namespace alight {
namespace {

void run(const ros::NodeHandle& node_handle) {
  const NodeConfig config = read_parameters(node_handle);
  const ReplayConfig replay = resolve(config);
  const Rig rig = load_rig(find_rig_file(replay.rig, config.config));
  LandingNode node(config, replay, rig, make_chosen_predictor(replay, rig, config.lidar_only));
  ROS_INFO("ready%s", config.lidar_only ? ", LiDAR alone" : "");
  node.run();
}

int run_node() {
  // With its last node handle ROS shuts down, logging included.
  const ros::NodeHandle node_handle("~");
  try {
    run(node_handle);
    return kExitOk;
  } catch (const ConfigError& e) {
    ROS_FATAL("%s", e.what());
    return kExitUsage;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return kExitFailure;
  }
}

}  // namespace
}  // namespace alight

int main(int argc, char** argv) {
  alight::restart_with_short_spin(argv);
  alight::keep_freed_memory();
  ros::init(argc, argv, "alight");
  return alight::run_node();
}
