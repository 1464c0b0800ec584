#include "dataset/messages/decoders.hpp"

#include <geometry_msgs/QuaternionStamped.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/Float32.h>

#include "dataset/messages/livox_custom_msg.hpp"

namespace alight {
namespace {

template <class Message>
Decoder row(LogRole role, DecodeFunction decode) {
  return {ros::message_traits::DataType<Message>::value(), ros::message_traits::MD5Sum<Message>::value(),
          role, decode};
}

}  // namespace

const std::vector<Decoder>& decoders() {
  static const std::vector<Decoder> table = {
      row<sensor_msgs::Image>(LogRole::kImage, decode_image),
      row<sensor_msgs::CompressedImage>(LogRole::kImage, decode_compressed_image),
      row<livox_ros_driver::CustomMsg>(LogRole::kLidar, decode_livox),
      {"livox_ros_driver2/CustomMsg", ros::message_traits::MD5Sum<livox_ros_driver::CustomMsg>::value(),
       LogRole::kLidar, decode_livox},
      row<geometry_msgs::QuaternionStamped>(LogRole::kAttitude, decode_quaternion),
      row<sensor_msgs::Imu>(LogRole::kAttitude, decode_imu_attitude),
      row<sensor_msgs::NavSatFix>(LogRole::kPosition, decode_fix),
      row<std_msgs::Float32>(LogRole::kHeight, decode_float_height),
  };
  return table;
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
