#include "sensors/messages/decoders.hpp"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Float32.h>

#include "foundation/errors.hpp"
#include "sensors/messages/camera_info_decoder.hpp"
#include "sensors/messages/image_decoders.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/messages/livox_decoder.hpp"
#include "sensors/messages/point_cloud_decoder.hpp"
#include "sensors/messages/pose_decoders.hpp"
#include "sensors/messages/vehicle_decoders.hpp"

namespace alight {
namespace {

/// tf2's message is tf's under another name; its headers come with a package that nothing else here needs.
constexpr const char* kTfMd5 = "94810edda583a504dfda3829e70d7eec";

template <class Message>
Decoder row(LogRole role, DecodeFunction decode) {
  return {ros::message_traits::DataType<Message>::value(), ros::message_traits::MD5Sum<Message>::value(),
          role, decode};
}

/// A deque: rows stay where they are when another one comes.
std::deque<Decoder>& table() {
  static std::deque<Decoder> rows = {
      row<sensor_msgs::Image>(LogRole::kImage, decode_image),
      row<sensor_msgs::CompressedImage>(LogRole::kImage, decode_compressed_image),
      row<livox_ros_driver::CustomMsg>(LogRole::kLidar, decode_livox),
      {"livox_ros_driver2/CustomMsg", ros::message_traits::MD5Sum<livox_ros_driver::CustomMsg>::value(),
       LogRole::kLidar, decode_livox2},
      row<sensor_msgs::PointCloud2>(LogRole::kLidar, decode_point_cloud),
      row<geometry_msgs::QuaternionStamped>(LogRole::kAttitude, decode_quaternion),
      row<sensor_msgs::Imu>(LogRole::kAttitude, decode_imu_attitude),
      row<geometry_msgs::PoseStamped>(LogRole::kAttitude, decode_pose_attitude),
      row<nav_msgs::Odometry>(LogRole::kAttitude, decode_odometry_attitude),
      row<geometry_msgs::TransformStamped>(LogRole::kAttitude, decode_transform_attitude),
      {"tf2_msgs/TFMessage", kTfMd5, LogRole::kAttitude, decode_tf_attitude},
      {"tf/tfMessage", kTfMd5, LogRole::kAttitude, decode_tf_attitude},
      row<sensor_msgs::NavSatFix>(LogRole::kPosition, decode_fix),
      row<geometry_msgs::PointStamped>(LogRole::kPosition, decode_point),
      row<geometry_msgs::PoseStamped>(LogRole::kPosition, decode_pose_position),
      row<nav_msgs::Odometry>(LogRole::kPosition, decode_odometry_position),
      row<geometry_msgs::TransformStamped>(LogRole::kPosition, decode_transform_position),
      {"tf2_msgs/TFMessage", kTfMd5, LogRole::kPosition, decode_tf_position},
      {"tf/tfMessage", kTfMd5, LogRole::kPosition, decode_tf_position},
      row<std_msgs::Float32>(LogRole::kHeight, decode_float_height),
      row<sensor_msgs::CameraInfo>(LogRole::kCameraInfo, decode_camera_info),
  };
  return rows;
}

}  // namespace

const std::deque<Decoder>& decoders() { return table(); }

void add_decoder(Decoder row) {
  if (find_decoder(row.role, row.type) != nullptr)
    throw ConfigError(row.type + ": is read as " + name(row.role) + " already; leave out add_decoder");
  table().push_back(std::move(row));
}

const char* name(LogRole role) {
  switch (role) {
    case LogRole::kImage:
      return "camera";
    case LogRole::kLidar:
      return "LiDAR";
    case LogRole::kAttitude:
      return "attitude";
    case LogRole::kPosition:
      return "position";
    case LogRole::kHeight:
      return "height";
    case LogRole::kCameraInfo:
      break;
  }
  return "intrinsics";
}

bool is_transform_tree(const Decoder& decoder) {
  return decoder.decode == decode_tf_attitude || decoder.decode == decode_tf_position;
}

const Decoder* find_decoder(LogRole role, const std::string& type) {
  for (const Decoder& decoder : decoders()) {
    if (decoder.role == role && decoder.type == type) return &decoder;
  }
  return nullptr;
}

std::string accepted_types(LogRole role) {
  std::string types;
  for (const Decoder& decoder : decoders()) {
    if (decoder.role == role) types += (types.empty() ? "" : ", ") + decoder.type;
  }
  return types;
}

}  // namespace alight
