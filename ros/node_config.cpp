#include "ros/node_config.hpp"

#include <vector>

#include <yaml-cpp/yaml.h>

#include "foundation/config_reader.hpp"
#include "foundation/shipped_files.hpp"

namespace alight {
namespace {

/// A parameter as a configuration file would have it; a list or map, which no parameter of ours is, as such.
YAML::Node to_yaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool&>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int&>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(static_cast<double&>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string&>(value));
    default:
      return YAML::Node(YAML::NodeType::Sequence);
  }
}

}  // namespace

void bind(Binder& b, NodeConfig& c) {
  b.field("config", c.config, "configuration file as configs/infer/*.yaml; empty: the built-in defaults");
  b.field("rig", c.rig, "rig file in place of the configuration's");
  b.field("checkpoint", c.checkpoint, "trained network in place of the configuration's");
  b.field("lidar_only", c.lidar_only, "no network: interpolate the LiDAR of max_accumulation_s");
  b.choice("mode", c.mode, {{"automatic", FlightMode::kAutomatic}, {"manual", FlightMode::kManual}},
           "at the start");
  b.field("camera_frame", c.frames.camera, "of depth and points");
  b.field("level_frame", c.frames.level, "of the safe mask");
  b.field("map_frame", c.frames.map, "of the landing site");
  b.field("point_step_px", c.point_step_px, "every so many pixels, in both directions, is a point",
          between(1, 1000));
  b.field("publish_tf", c.publish_tf, "map -> camera -> level on /tf");
}

NodeConfig read_parameters(const ros::NodeHandle& node) {
  YAML::Node document(YAML::NodeType::Map);
  XmlRpc::XmlRpcValue parameters;
  if (node.getParam(node.getNamespace(), parameters) &&
      parameters.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    for (auto& [key, value] : parameters) document[key] = to_yaml(value);
  }
  return bind_node<NodeConfig>(document, "parameters of " + node.getNamespace());
}

ReplayConfig resolve(const NodeConfig& config) {
  ReplayConfig replay =
      config.config.empty() ? ReplayConfig{} : load_config<ReplayConfig>(input_file(config.config));
  if (!config.rig.empty()) replay.rig = config.rig;
  if (!config.checkpoint.empty()) replay.checkpoint = config.checkpoint;
  return replay;
}

}  // namespace alight
