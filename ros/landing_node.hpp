#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>

#include "infer/onboard/engine_runner.hpp"
#include "ros/report_publisher.hpp"
#include "ros/topic_reader.hpp"

namespace alight {

/// Topics in, depth and landing site out: the engine of alight-infer behind ROS 1.
class LandingNode {
 public:
  /// @param predictor null: LiDAR alone. @throws ConfigError
  LandingNode(const NodeConfig& config, const ReplayConfig& replay, const Rig& rig,
              std::shared_ptr<DepthPredictor> predictor);

  /// Serves until ROS shuts down. @throws what the engine threw
  void run();

 private:
  void receive(LogMessage message);
  bool jumped_back(const LogMessage& message);
  std::unique_ptr<LandingPipeline> make_pipeline() const;
  void start_again();
  bool set_mode(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void publish_mode();
  void every_second();
  void warn_of_silence(const std::vector<TopicState>& topics);

  ros::NodeHandle private_node_{"~"};
  ros::NodeHandle node_;
  NodeConfig config_;
  ReplayConfig replay_;
  Rig rig_;
  std::shared_ptr<DepthPredictor> predictor_;
  ModeSwitch mode_;
  std::unique_ptr<ReportPublisher> publisher_;
  std::unique_ptr<EngineRunner> runner_;
  std::unique_ptr<TopicReader> reader_;
  std::array<std::optional<std::int64_t>, std::variant_size_v<LogMessage>> last_ns_;  // by kind of message
  std::int64_t dropped_before_ = 0;
  std::set<std::string> silent_;
  ros::Publisher mode_publisher_;
  ros::Publisher diagnostics_;
  ros::ServiceServer set_mode_;
  ros::WallTimer timer_;
};

}  // namespace alight
