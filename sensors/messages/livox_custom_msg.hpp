#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

/// The Livox driver's point cloud message. Debian has no package of the driver, so the two generated headers
/// are restated here: https://github.com/Livox-SDK/livox_ros_driver, msg/CustomMsg.msg and
/// msg/CustomPoint.msg. `livox_ros_driver2/CustomMsg` is the same message with the same checksum under
/// another name.
namespace livox_ros_driver {

struct CustomPoint {
  std::uint32_t offset_time = 0;  ///< ns after the message's time
  float x = 0;                    ///< metres; (0, 0, 0) is "no return"
  float y = 0;
  float z = 0;
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
  std::uint8_t line = 0;
};

/// Bytes of one CustomPoint in a message.
constexpr std::size_t kCustomPointBytes = 19;

struct CustomMsg {
  std_msgs::Header header;
  std::uint64_t timebase = 0;  ///< ns, time of the first point; the driver puts the same time in header.stamp
  std::uint32_t point_num = 0;
  std::uint8_t lidar_id = 0;
  std::array<std::uint8_t, 3> rsvd = {0, 0, 0};
  std::vector<CustomPoint> points;
};

}  // namespace livox_ros_driver

namespace ros {
namespace message_traits {

template <>
struct IsMessage<livox_ros_driver::CustomPoint> : TrueType {};
template <>
struct IsMessage<const livox_ros_driver::CustomPoint> : TrueType {};
template <>
struct IsMessage<livox_ros_driver::CustomMsg> : TrueType {};
template <>
struct IsMessage<const livox_ros_driver::CustomMsg> : TrueType {};
template <>
struct HasHeader<livox_ros_driver::CustomMsg> : TrueType {};
template <>
struct HasHeader<const livox_ros_driver::CustomMsg> : TrueType {};

template <>
struct MD5Sum<livox_ros_driver::CustomPoint> {
  static const char* value() { return "109a3cc548bb1f96626be89a5008bd6d"; }
  static const char* value(const livox_ros_driver::CustomPoint&) { return value(); }
};
template <>
struct MD5Sum<livox_ros_driver::CustomMsg> {
  static const char* value() { return "e4d6829bdfe657cb6c21a746c86b21a6"; }
  static const char* value(const livox_ros_driver::CustomMsg&) { return value(); }
};

template <>
struct DataType<livox_ros_driver::CustomPoint> {
  static const char* value() { return "livox_ros_driver/CustomPoint"; }
  static const char* value(const livox_ros_driver::CustomPoint&) { return value(); }
};
template <>
struct DataType<livox_ros_driver::CustomMsg> {
  static const char* value() { return "livox_ros_driver/CustomMsg"; }
  static const char* value(const livox_ros_driver::CustomMsg&) { return value(); }
};

template <>
struct Definition<livox_ros_driver::CustomPoint> {
  static const char* value() {
    return "# Livox costom pointcloud format.\n"
           "\n"
           "uint32 offset_time      # offset time relative to the base time\n"
           "float32 x               # X axis, unit:m\n"
           "float32 y               # Y axis, unit:m\n"
           "float32 z               # Z axis, unit:m\n"
           "uint8 reflectivity      # reflectivity, 0~255\n"
           "uint8 tag               # livox tag\n"
           "uint8 line              # laser number in lidar\n";
  }
  static const char* value(const livox_ros_driver::CustomPoint&) { return value(); }
};
/// The full text, with the definitions of the contained types: readers without our headers decode by it.
template <>
struct Definition<livox_ros_driver::CustomMsg> {
  static const char* value() {
    return "# Livox publish pointcloud msg format.\n"
           "\n"
           "Header header             # ROS standard message header\n"
           "uint64 timebase           # The time of first point\n"
           "uint32 point_num          # Total number of pointclouds\n"
           "uint8  lidar_id           # Lidar device id number\n"
           "uint8[3]  rsvd            # Reserved use\n"
           "CustomPoint[] points      # Pointcloud data\n"
           "\n"
           "\n"
           "================================================================================\n"
           "MSG: std_msgs/Header\n"
           "# Standard metadata for higher-level stamped data types.\n"
           "# This is generally used to communicate timestamped data \n"
           "# in a particular coordinate frame.\n"
           "# \n"
           "# sequence ID: consecutively increasing ID \n"
           "uint32 seq\n"
           "#Two-integer timestamp that is expressed as:\n"
           "# * stamp.sec: seconds (stamp_secs) since epoch (in Python the variable is called 'secs')\n"
           "# * stamp.nsec: nanoseconds since stamp_secs (in Python the variable is called 'nsecs')\n"
           "# time-handling sugar is provided by the client library\n"
           "time stamp\n"
           "#Frame this data is associated with\n"
           "string frame_id\n"
           "\n"
           "================================================================================\n"
           "MSG: livox_ros_driver/CustomPoint\n"
           "# Livox costom pointcloud format.\n"
           "\n"
           "uint32 offset_time      # offset time relative to the base time\n"
           "float32 x               # X axis, unit:m\n"
           "float32 y               # Y axis, unit:m\n"
           "float32 z               # Z axis, unit:m\n"
           "uint8 reflectivity      # reflectivity, 0~255\n"
           "uint8 tag               # livox tag\n"
           "uint8 line              # laser number in lidar\n"
           "\n";
  }
  static const char* value(const livox_ros_driver::CustomMsg&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<livox_ros_driver::CustomPoint> {
  template <typename Stream, typename Point>
  static void allInOne(Stream& stream, Point point) {
    stream.next(point.offset_time);
    stream.next(point.x);
    stream.next(point.y);
    stream.next(point.z);
    stream.next(point.reflectivity);
    stream.next(point.tag);
    stream.next(point.line);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<livox_ros_driver::CustomMsg> {
  template <typename Stream, typename Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.header);
    stream.next(message.timebase);
    stream.next(message.point_num);
    stream.next(message.lidar_id);
    for (auto& byte : message.rsvd) stream.next(byte);
    stream.next(message.points);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros
