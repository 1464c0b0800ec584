#include "ros/landing_node.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/init.h>
#include <std_msgs/String.h>

#include "ros/report_messages.hpp"

namespace alight {
namespace {

/// Messages of one kind may overtake each other by less.
constexpr std::int64_t kJump_ns = 1'000'000'000;
constexpr double kSpin_s = 0.1;

const char* name(FlightMode mode) { return mode == FlightMode::kAutomatic ? "automatic" : "manual"; }

}  // namespace

LandingNode::LandingNode(const NodeConfig& config, const ReplayConfig& replay, const Rig& rig,
                         std::shared_ptr<DepthPredictor> predictor)
    : config_(config), replay_(replay), rig_(rig), predictor_(std::move(predictor)), mode_(config.mode) {
  auto pipeline = make_pipeline();
  publisher_ = std::make_unique<ReportPublisher>(private_node_, config_, pipeline->engine(), mode_);
  runner_ = std::make_unique<EngineRunner>(replay_.queue, std::move(pipeline),
                                           std::vector<FrameSink*>{publisher_.get()});
  mode_publisher_ = private_node_.advertise<std_msgs::String>("mode", 1, true);
  publish_mode();
  diagnostics_ = node_.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  set_mode_ = private_node_.advertiseService("set_mode", &LandingNode::set_mode, this);
  reader_ = std::make_unique<TopicReader>(node_, rig_, replay_.log,
                                          [this](LogMessage message) { receive(std::move(message)); });
  timer_ =
      node_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { every_second(); });
}

void LandingNode::run() {
  while (ros::ok() && !runner_->failed()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kSpin_s));
  }
  if (runner_->failed()) runner_->finish();
}

void LandingNode::receive(LogMessage message) {
  if (jumped_back(message)) start_again();
  last_ns_[message.index()] = std::visit([](const auto& typed) { return typed.t_ns; }, message);
  runner_->push(std::move(message));
}

bool LandingNode::jumped_back(const LogMessage& message) {
  const auto& last_ns = last_ns_[message.index()];
  const std::int64_t t_ns = std::visit([](const auto& typed) { return typed.t_ns; }, message);
  if (!last_ns || *last_ns - t_ns <= kJump_ns) return false;
  ROS_WARN("the stamps jump back by %.1f s: the engine starts anew", to_seconds(*last_ns - t_ns));
  return true;
}

std::unique_ptr<LandingPipeline> LandingNode::make_pipeline() const {
  return std::make_unique<LandingPipeline>(replay_.engine, replay_.landing, rig_, predictor_);
}

/// Ends one engine before the next begins: the network is theirs in turn.
void LandingNode::start_again() {
  last_ns_.fill(std::nullopt);
  dropped_before_ = 0;
  reader_->restart();
  runner_.reset();
  publisher_->forget();
  runner_ = std::make_unique<EngineRunner>(replay_.queue, make_pipeline(),
                                           std::vector<FrameSink*>{publisher_.get()});
}

bool LandingNode::set_mode(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  mode_.set(request.data != 0 ? FlightMode::kAutomatic : FlightMode::kManual);
  publish_mode();
  response.success = 1;
  response.message = std::string("mode: ") + name(mode_.get());
  ROS_INFO("%s", response.message.c_str());
  return true;
}

void LandingNode::publish_mode() {
  std_msgs::String mode;
  mode.data = name(mode_.get());
  mode_publisher_.publish(mode);
}

void LandingNode::every_second() {
  const std::vector<TopicState> topics = reader_->topics();
  warn_of_silence(topics);
  const RunnerStatistics statistics = runner_->statistics();
  const std::optional<FrameReport> last = publisher_->last();
  const std::string& node = ros::this_node::getName();
  diagnostic_msgs::DiagnosticArray diagnostics;
  diagnostics.header.stamp = ros::Time::now();
  diagnostics.status = {
      sensor_status(node, last ? last->health : HealthReport{}), topic_status(node, topics),
      engine_status(node, statistics, reader_->dropped(), last ? &*last : nullptr, dropped_before_)};
  diagnostics_.publish(diagnostics);
  dropped_before_ = total(statistics.dropped);
}

void LandingNode::warn_of_silence(const std::vector<TopicState>& topics) {
  std::set<std::string> silent;
  std::string text;
  for (const TopicState& topic : topics) {
    if (!topic.silent) continue;
    silent.insert(topic.topic);
    text += (text.empty() ? "" : ", ") + topic.topic + " (" + topic.sensors +
            (topic.published ? ")" : "; nobody publishes it)");
  }
  if (silent == silent_) return;
  silent_ = std::move(silent);
  if (silent_.empty()) {
    ROS_INFO("every topic delivers again");
  } else {
    ROS_WARN("silent for %.0f s and more: %s", TopicReader::kSilence_s, text.c_str());
  }
}

}  // namespace alight
