#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dataset/messages/byte_reader.hpp"
#include "dataset/messages/message_types.hpp"

/// From the bytes of a ROS 1 message to our types. To add a type: write its decode function, give it a row in
/// the table of decoders.cpp and a test.
namespace alight {

/// What a topic is read as. One ROS type may have a row for several (an odometry is attitude and position).
enum class LogRole { kImage, kLidar, kAttitude, kPosition, kHeight };

/// What decoders need to know of the configuration.
struct DecodeOptions {
  double min_range_m = 0.5;  ///< LiDAR returns nearer or farther are dropped
  double max_range_m = 300.0;
};

/// Empty: the message is in order and says that it holds no measurement (a receiver without a fix).
/// @throws DecodeError if the bytes are not what the type promises
using DecodeFunction = std::optional<DecodedMessage> (*)(const RawMessage&, const DecodeOptions&);

/// One row of the table: a ROS type that can be read for a role.
struct Decoder {
  std::string type;  ///< "sensor_msgs/Image"
  std::string md5;   ///< of the message definition; another one is another message under the same name
  LogRole role;
  DecodeFunction decode;
};

/// The table.
const std::vector<Decoder>& decoders();
/// Null if no row has this type and role.
const Decoder* find_decoder(LogRole role, const std::string& type);
/// "geometry_msgs/QuaternionStamped, sensor_msgs/Imu"
std::string accepted_types(LogRole role);

/// sensor_msgs/Image: mono8, rgb8, bgr8, bayer_{rggb,bggr,gbrg,grbg}8.
std::optional<DecodedMessage> decode_image(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/CompressedImage: JPEG and PNG.
std::optional<DecodedMessage> decode_compressed_image(const RawMessage& message,
                                                      const DecodeOptions& options);
/// livox_ros_driver/CustomMsg. A point's time is header.stamp + offset_time: the stamp is what clock
/// corrections rewrite, `timebase` stays on the sensor's own clock.
std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options);
/// geometry_msgs/QuaternionStamped.
std::optional<DecodedMessage> decode_quaternion(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/Imu, its orientation; empty where the message says that it has none (covariance[0] = -1).
std::optional<DecodedMessage> decode_imu_attitude(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/NavSatFix; empty where the receiver has no fix.
std::optional<DecodedMessage> decode_fix(const RawMessage& message, const DecodeOptions& options);
/// std_msgs/Float32 as a height; it has no stamp, its time is the receive time.
std::optional<DecodedMessage> decode_float_height(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
