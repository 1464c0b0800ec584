#include "ros/report_publisher.hpp"

#include <std_msgs/String.h>

#include "infer/replay/result_writer.hpp"
#include "ros/report_messages.hpp"

namespace alight {
namespace {

// Images that waited for the same LiDAR packet become final together (engine.max_open_images).
constexpr std::uint32_t kQueuedImages = 30;
constexpr std::uint32_t kQueuedOthers = 100;

}  // namespace

ReportPublisher::ReportPublisher(ros::NodeHandle node, const NodeConfig& config, const DepthEngine& engine,
                                 const ModeSwitch& mode)
    : config_(config), intrinsics_(engine.rig().intrinsics), crop_(engine.crop()), mode_(mode) {
  depth_ = node.advertise<sensor_msgs::Image>("depth/image", kQueuedImages);
  camera_info_ = node.advertise<sensor_msgs::CameraInfo>("depth/camera_info", kQueuedOthers);
  points_ = node.advertise<sensor_msgs::PointCloud2>("points", kQueuedImages);
  safe_mask_ = node.advertise<sensor_msgs::Image>("safe_mask", kQueuedImages);
  site_ = node.advertise<geometry_msgs::PoseStamped>("landing_site", kQueuedOthers);
  marker_ = node.advertise<visualization_msgs::Marker>("landing_site_marker", kQueuedOthers);
  result_ = node.advertise<std_msgs::String>("result", kQueuedOthers);
  if (config.publish_tf) tf_ = node.advertise<tf2_msgs::TFMessage>("/tf", kQueuedOthers);
}

void ReportPublisher::on_frame(const FrameReport& frame) {
  if (config_.publish_tf) tf_.publish(transforms(frame, config_.frames));
  publish_images(frame);
  publish_site(frame);
  if (result_.getNumSubscribers() > 0) {
    std_msgs::String line;
    line.data = to_json_line(frame, crop_, true);
    result_.publish(line);
  }
  const std::lock_guard lock(mutex_);
  last_ = frame;
}

void ReportPublisher::publish_images(const FrameReport& frame) {
  const FrameNames& names = config_.frames;
  if (depth_.getNumSubscribers() > 0) depth_.publish(depth_image(frame, intrinsics_, names));
  camera_info_.publish(camera_info(frame, intrinsics_, names));
  if (points_.getNumSubscribers() > 0)
    points_.publish(points(frame, intrinsics_, config_.point_step_px, names));
  if (safe_mask_.getNumSubscribers() > 0) safe_mask_.publish(safe_mask(frame, intrinsics_, names));
}

/// In manual mode a person flies: the site is shown, but not handed to whoever follows it.
void ReportPublisher::publish_site(const FrameReport& frame) {
  marker_.publish(landing_site_marker(frame, config_.frames));
  const auto& site = frame.decision.site;
  if (!site || !site->accepted || mode_.get() != FlightMode::kAutomatic) return;
  site_.publish(landing_site(frame, *site, config_.frames));
}

std::optional<FrameReport> ReportPublisher::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

void ReportPublisher::forget() {
  const std::lock_guard lock(mutex_);
  last_.reset();
}

}  // namespace alight
