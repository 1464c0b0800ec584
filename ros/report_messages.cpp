#include "ros/report_messages.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr int kCircleCorners = 48;
constexpr const char* kMarkerNamespace = "landing_site";

std_msgs::Header header(const FrameReport& frame, const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp.fromNSec(static_cast<std::uint64_t>(frame.depth.t_ns));
  header.frame_id = frame_id;
  return header;
}

sensor_msgs::Image image(const std_msgs::Header& header, const cv::Mat& pixels, const std::string& encoding) {
  sensor_msgs::Image message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(pixels.cols);
  message.height = static_cast<std::uint32_t>(pixels.rows);
  message.encoding = encoding;
  message.step = static_cast<std::uint32_t>(static_cast<std::size_t>(pixels.cols) * pixels.elemSize());
  message.data.resize(static_cast<std::size_t>(message.step) * message.height);
  for (int v = 0; v < pixels.rows; ++v) {
    std::memcpy(&message.data[static_cast<std::size_t>(v) * message.step], pixels.ptr(v), message.step);
  }
  return message;
}

sensor_msgs::PointField field(const std::string& name, std::uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  return field;
}

/// A point of the cloud. `rgb` is what RViz and PCL expect: 0x00rrggbb in the bits of a float.
struct CloudPoint {
  float x;
  float y;
  float z;
  std::uint32_t rgb;
};

geometry_msgs::TransformStamped transform(const std_msgs::Header& header, const std::string& child,
                                          const Eigen::Isometry3d& T_parent_child) {
  geometry_msgs::TransformStamped message;
  message.header = header;
  message.child_frame_id = child;
  const Eigen::Vector3d t = T_parent_child.translation();
  const Eigen::Quaterniond q(T_parent_child.linear());
  message.transform.translation.x = t.x();
  message.transform.translation.y = t.y();
  message.transform.translation.z = t.z();
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  message.transform.rotation.w = q.w();
  return message;
}

geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point message;
  message.x = p.x();
  message.y = p.y();
  message.z = p.z();
  return message;
}

diagnostic_msgs::DiagnosticStatus status(const std::string& node, const std::string& part) {
  diagnostic_msgs::DiagnosticStatus status;
  status.name = node + ": " + part;
  status.hardware_id = "alight";
  status.level = diagnostic_msgs::DiagnosticStatus::OK;
  status.message = "ok";
  return status;
}

void add_value(diagnostic_msgs::DiagnosticStatus& status, const std::string& key, std::string value) {
  diagnostic_msgs::KeyValue pair;
  pair.key = key;
  pair.value = std::move(value);
  status.values.push_back(std::move(pair));
}

/// The worst thing said gives the level; everything said is in the message.
void complain(diagnostic_msgs::DiagnosticStatus& status, std::int8_t level, const std::string& text) {
  status.message =
      status.level == diagnostic_msgs::DiagnosticStatus::OK ? text : status.message + "; " + text;
  status.level =
      static_cast<std::uint8_t>(level) > static_cast<std::uint8_t>(status.level) ? level : status.level;
}

}  // namespace

std::int64_t total(const std::map<std::string, std::int64_t>& counts) {
  std::int64_t sum = 0;
  for (const auto& [reason, count] : counts) sum += count;
  return sum;
}

sensor_msgs::Image depth_image(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                               const FrameNames& names) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  cv::Mat depth_m;
  if (frame.depth.depth_m.empty()) {
    depth_m = cv::Mat(intrinsics.size(), CV_32FC1, cv::Scalar(static_cast<double>(kUnknown)));
  } else {
    depth_m = frame.depth.depth_m.clone();
    depth_m.setTo(cv::Scalar(static_cast<double>(kUnknown)), frame.depth.depth_m == 0);
  }
  return image(header(frame, names.camera), depth_m, "32FC1");
}

sensor_msgs::CameraInfo camera_info(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                                    const FrameNames& names) {
  sensor_msgs::CameraInfo info;
  info.header = header(frame, names.camera);
  info.width = static_cast<std::uint32_t>(intrinsics.width_px);
  info.height = static_cast<std::uint32_t>(intrinsics.height_px);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {intrinsics.fx_px, 0, intrinsics.cx_px, 0, intrinsics.fy_px, intrinsics.cy_px, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {intrinsics.fx_px, 0, intrinsics.cx_px, 0, 0, intrinsics.fy_px, intrinsics.cy_px, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::PointCloud2 points(const FrameReport& frame, const PinholeIntrinsics& intrinsics, int step_px,
                                const FrameNames& names) {
  std::vector<CloudPoint> cloud;
  const cv::Mat& depth_m = frame.depth.depth_m;
  cv::Mat bgr = frame.depth.left;
  if (!bgr.empty() && bgr.channels() == 1) cv::cvtColor(bgr, bgr, cv::COLOR_GRAY2BGR);
  for (int v = 0; v < depth_m.rows; v += step_px) {
    for (int u = 0; u < depth_m.cols; u += step_px) {
      const float depth = depth_m.at<float>(v, u);
      if (depth == 0) continue;
      const Eigen::Vector3f p = (static_cast<double>(depth) * intrinsics.ray(u, v)).cast<float>();
      const auto& colour = bgr.at<cv::Vec3b>(v, u);
      const auto rgb = static_cast<std::uint32_t>((colour[2] << 16) | (colour[1] << 8) | colour[0]);
      cloud.push_back({p.x(), p.y(), depth, rgb});
    }
  }
  sensor_msgs::PointCloud2 message;
  message.header = header(frame, names.camera);
  message.height = 1;
  message.width = static_cast<std::uint32_t>(cloud.size());
  message.fields = {field("x", 0), field("y", 4), field("z", 8), field("rgb", 12)};
  message.point_step = sizeof(CloudPoint);
  message.row_step = message.point_step * message.width;
  message.is_dense = true;
  message.data.resize(message.row_step);
  if (!cloud.empty()) std::memcpy(message.data.data(), cloud.data(), message.data.size());
  return message;
}

sensor_msgs::Image safe_mask(const FrameReport& frame, const PinholeIntrinsics& intrinsics,
                             const FrameNames& names) {
  const std_msgs::Header stamped = header(frame, names.level);
  if (frame.selection && !frame.selection->safe.empty())
    return image(stamped, frame.selection->safe, "mono8");
  return image(stamped, cv::Mat::zeros(intrinsics.size(), CV_8UC1), "mono8");
}

geometry_msgs::PoseStamped landing_site(const FrameReport& frame, const TrackedSite& site,
                                        const FrameNames& names) {
  geometry_msgs::PoseStamped message;
  message.header = header(frame, names.map);
  message.pose.position = point(site.p_world);
  message.pose.orientation.w = 1;
  return message;
}

visualization_msgs::Marker landing_site_marker(const FrameReport& frame, const FrameNames& names) {
  visualization_msgs::Marker marker;
  marker.header = header(frame, names.map);
  marker.ns = kMarkerNamespace;
  marker.type = visualization_msgs::Marker::LINE_STRIP;
  marker.action = visualization_msgs::Marker::DELETE;
  marker.pose.orientation.w = 1;
  if (!frame.decision.site) return marker;
  const TrackedSite& site = *frame.decision.site;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.position = point(site.p_world);
  marker.scale.x = 0.1;  // width of the line, metres
  marker.color.r = site.accepted ? 0.0f : 1.0f;
  marker.color.g = 1.0f;
  marker.color.a = 1.0f;
  for (int i = 0; i <= kCircleCorners; ++i) {
    const double angle_rad = 2 * kPi * i / kCircleCorners;
    marker.points.push_back(
        point(site.circle.radius_m * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0)));
  }
  return marker;
}

tf2_msgs::TFMessage transforms(const FrameReport& frame, const FrameNames& names) {
  tf2_msgs::TFMessage message;
  if (!frame.depth.T_world_camera) return message;
  message.transforms.push_back(
      transform(header(frame, names.map), names.camera, *frame.depth.T_world_camera));
  if (frame.selection) {
    Eigen::Isometry3d T_camera_level = Eigen::Isometry3d::Identity();
    T_camera_level.linear() = frame.selection->R_level_camera.transpose();
    message.transforms.push_back(transform(header(frame, names.camera), names.level, T_camera_level));
  }
  return message;
}

diagnostic_msgs::DiagnosticStatus sensor_status(const std::string& node, const HealthReport& health) {
  diagnostic_msgs::DiagnosticStatus sensors = status(node, "sensors");
  for (const HealthFinding& finding : health.findings) {
    complain(sensors, diagnostic_msgs::DiagnosticStatus::WARN, finding.sensor + " " + finding.fault);
    add_value(sensors, finding.sensor + " " + finding.fault, finding.reason);
  }
  if (health.state == HealthState::kDegraded) sensors.level = diagnostic_msgs::DiagnosticStatus::WARN;
  if (health.state == HealthState::kFailed) sensors.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  if (health.state != HealthState::kOk && health.findings.empty()) sensors.message = name(health.state);
  add_value(sensors, "state", name(health.state));
  return sensors;
}

diagnostic_msgs::DiagnosticStatus topic_status(const std::string& node,
                                               const std::vector<TopicState>& topics) {
  diagnostic_msgs::DiagnosticStatus status_of_topics = status(node, "topics");
  for (const TopicState& topic : topics) {
    std::string value = topic.sensors + ": " + std::to_string(topic.messages) + " messages";
    if (!topic.problem.empty()) {
      complain(status_of_topics, diagnostic_msgs::DiagnosticStatus::ERROR, topic.problem);
    } else if (topic.silent) {
      complain(status_of_topics, diagnostic_msgs::DiagnosticStatus::WARN, topic.topic + " is silent");
      value += topic.published ? ", silent" : ", nobody publishes it";
    }
    add_value(status_of_topics, topic.topic, value);
  }
  return status_of_topics;
}

diagnostic_msgs::DiagnosticStatus engine_status(const std::string& node, const RunnerStatistics& statistics,
                                                const std::map<std::string, std::int64_t>& not_read,
                                                const FrameReport* last, std::int64_t dropped_before) {
  diagnostic_msgs::DiagnosticStatus engine = status(node, "engine");
  if (last == nullptr) complain(engine, diagnostic_msgs::DiagnosticStatus::WARN, "no result yet");
  if (const std::int64_t lost = total(statistics.dropped) - dropped_before; lost > 0) {
    complain(engine, diagnostic_msgs::DiagnosticStatus::WARN,
             std::to_string(lost) + " messages or points left out");
  }
  add_value(engine, "images", std::to_string(statistics.images));
  add_value(engine, "messages waiting", std::to_string(statistics.queued));
  add_value(engine, "latency_ms", std::to_string(std::lround(statistics.last_latency_ms)));
  add_value(engine, "latency_p95_ms", std::to_string(std::lround(statistics.latency_ms(0.95))));
  add_value(engine, "latency_max_ms", std::to_string(std::lround(statistics.max_latency_ms)));
  if (last != nullptr) {
    add_value(engine, "source", name(last->depth.source));
    add_value(engine, "reason", last->depth.reason);
    add_value(engine, "site", last->site_reason());
  }
  for (const auto& [reason, count] : statistics.dropped)
    add_value(engine, "dropped: " + reason, std::to_string(count));
  for (const auto& [reason, count] : not_read)
    add_value(engine, "not read: " + reason, std::to_string(count));
  return engine;
}

}  // namespace alight
