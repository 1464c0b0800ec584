#pragma once

#include <string>
#include <utility>
#include <variant>

#include "geometry/rig/rig.hpp"
#include "sim/record/message_schedule.hpp"
#include "sim/record/sensor_messages.hpp"
#include "sim/sensors/stereo_camera.hpp"

namespace alight::sim {

/// Topics besides those of the rig, as DJI's SDK names them.
inline constexpr const char* kAttitudeTopic = "/dji_sdk/attitude";
inline constexpr const char* kImuTopic = "/dji_sdk/imu";
inline constexpr const char* kPositionTopic = "/dji_sdk/gps_position";
inline constexpr const char* kHeightTopic = "/dji_sdk/height_above_takeoff";

/// A measurement as the recording computer receives it.
struct RecordedMessage {
  using Content = std::variant<geometry_msgs::QuaternionStamped, sensor_msgs::Imu, sensor_msgs::NavSatFix,
                               std_msgs::Float32, livox_ros_driver::CustomMsg, sensor_msgs::Image,
                               sensor_msgs::CompressedImage>;
  std::string topic;
  std::int64_t receive_ns = 0;  ///< since 1970
  Content content;
};

/// From measurements to messages: topics, stamps on each sensor's own clock, image format.
class MessageMaker {
 public:
  MessageMaker(const SensorsConfig& sensors, const Rig& rig) : sensors_(sensors), rig_(rig) {}

  /// Attitude, IMU, position or height, by the message's stream.
  RecordedMessage pose(const PoseSensors& sensor, const ScheduledMessage& message) const;
  RecordedMessage lidar(const LidarSensor& sensor, const ScheduledMessage& message) const;
  /// Left and right image.
  std::pair<RecordedMessage, RecordedMessage> images(const StereoExposure& exposure,
                                                     const ScheduledMessage& message) const;
  /// Stamp of an image.
  std::int64_t image_stamp_ns(const ScheduledMessage& message) const;

 private:
  std::int64_t on_clock(const ScheduledMessage& message, double clock_offset_s) const;
  RecordedMessage recorded(std::string topic, const ScheduledMessage& message,
                           RecordedMessage::Content content) const;
  RecordedMessage image(const std::string& topic, const std::string& frame, const ScheduledMessage& message,
                        const cv::Mat& pixels) const;

  SensorsConfig sensors_;
  Rig rig_;
};

}  // namespace alight::sim
