#pragma once

#include <string>
#include <variant>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/NavSatFix.h>

#include "geometry/rig/rig.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/messages/message_types.hpp"

/// The fakes' messages as a ROS 1 bag on the default topics.
namespace alight::fakes {

class BagWriter {
 public:
  BagWriter(const std::string& path, const Rig& rig) : bag_(path, rosbag::bagmode::Write), rig_(rig) {}

  void operator()(const StereoFrame& frame) {
    write(rig_.cam0.topic, frame.t_ns, image(frame.left, frame.t_ns));
    if (!frame.right.empty()) write(rig_.cam1->topic, frame.t_ns, image(frame.right, frame.t_ns));
  }
  void operator()(const LidarPacket& packet) {
    livox_ros_driver::CustomMsg message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(packet.t_ns));
    message.timebase = static_cast<std::uint64_t>(packet.t_ns);
    for (const LidarReturn& echo : packet.returns) {
      livox_ros_driver::CustomPoint point;
      point.offset_time = static_cast<std::uint32_t>(echo.t_ns - packet.t_ns);
      point.x = echo.p_lidar.x();
      point.y = echo.p_lidar.y();
      point.z = echo.p_lidar.z();
      message.points.push_back(point);
    }
    message.point_num = static_cast<std::uint32_t>(message.points.size());
    write(rig_.lidar0->topic, packet.returns.back().t_ns, message);
  }
  void operator()(const AttitudeSample& sample) {
    geometry_msgs::QuaternionStamped message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(sample.t_ns));
    message.quaternion.w = sample.q_world_imu.w();
    message.quaternion.x = sample.q_world_imu.x();
    message.quaternion.y = sample.q_world_imu.y();
    message.quaternion.z = sample.q_world_imu.z();
    write("/dji_sdk/attitude", sample.t_ns, message);
  }
  void operator()(const PositionSample& sample) {
    sensor_msgs::NavSatFix message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(sample.t_ns));
    const auto& fix = std::get<GeodeticPosition>(sample.position);
    message.latitude = fix.latitude_deg;
    message.longitude = fix.longitude_deg;
    message.altitude = fix.altitude_m;
    write("/dji_sdk/gps_position", sample.t_ns, message);
  }
  void operator()(const HeightSample&) {}

 private:
  static sensor_msgs::Image image(const cv::Mat& pixels, std::int64_t t_ns) {
    sensor_msgs::Image message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(t_ns));
    message.width = static_cast<std::uint32_t>(pixels.cols);
    message.height = static_cast<std::uint32_t>(pixels.rows);
    message.encoding = "mono8";
    message.step = message.width;
    for (int v = 0; v < pixels.rows; ++v) {
      const std::uint8_t* row = pixels.ptr<std::uint8_t>(v);
      message.data.insert(message.data.end(), row, row + pixels.cols);
    }
    return message;
  }
  template <class Message>
  void write(const std::string& topic, std::int64_t t_ns, const Message& message) {
    ros::Time time;
    time.fromNSec(static_cast<std::uint64_t>(t_ns));
    bag_.write(topic, time, message);
  }

  rosbag::Bag bag_;
  Rig rig_;
};

inline void write_bag(const std::string& path, const Rig& rig, const std::vector<LogMessage>& messages) {
  BagWriter writer(path, rig);
  for (const LogMessage& message : messages) std::visit(writer, message);
}

}  // namespace alight::fakes
