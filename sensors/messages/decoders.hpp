#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/rig/point_timing.hpp"
#include "sensors/messages/byte_reader.hpp"
#include "sensors/messages/message_types.hpp"

/// From the bytes of a ROS 1 message to our types. To add a type: write its decode function, give it a row in
/// the table of decoders.cpp and a test; from outside, a row by add_decoder.
namespace alight {

/// What a topic is read as. One ROS type may have a row for several (an odometry is attitude and position).
enum class LogRole { kImage, kLidar, kAttitude, kPosition, kHeight, kCameraInfo };
/// "camera", "LiDAR", "attitude", "position", "height", "intrinsics"
const char* name(LogRole role);

constexpr std::uint32_t kMaxImageSide_px = 16384;

/// Two frames of a tree of transforms: the vehicle's pose is that of `body` in `world`.
struct TransformFrames {
  std::string world;
  std::string body;
};

/// What decoders need to know of the configuration.
struct DecodeOptions {
  double min_range_m = 0.5;  ///< LiDAR returns nearer or farther are dropped
  double max_range_m = 300.0;
  StampSource stamp = StampSource::kHeader;
  PointTiming points;
  double reflectivity_scale = 1;
  TransformFrames frames;
};

/// Reads the header at the begin of a message. @returns the time that `options` choose for the message, ns
inline std::int64_t read_stamp(ByteReader& reader, const RawMessage& message, const DecodeOptions& options) {
  const std::int64_t stamp_ns = reader.read_header().stamp_ns;
  return options.stamp == StampSource::kHeader ? stamp_ns : message.receive_ns;
}

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

/// True for a type whose messages hold the transforms of many frames.
bool is_transform_tree(const Decoder& decoder);
/// The table.
const std::deque<Decoder>& decoders();
/// A row of the user's own, for a message type that the table does not have (examples/own_lidar.cpp). Call it before
/// logs are opened or threads started. @throws ConfigError if there is a row for this type and role
void add_decoder(Decoder row);
/// Null if no row has this type and role.
const Decoder* find_decoder(LogRole role, const std::string& type);
/// "geometry_msgs/QuaternionStamped, sensor_msgs/Imu"
std::string accepted_types(LogRole role);

/// sensor_msgs/Image: mono8, mono16, rgb8, bgr8, rgba8, bgra8, bayer_{rggb,bggr,gbrg,grbg}8, yuv422, yuv422_yuy2.
std::optional<DecodedMessage> decode_image(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/CompressedImage: JPEG and PNG.
std::optional<DecodedMessage> decode_compressed_image(const RawMessage& message,
                                                      const DecodeOptions& options);
/// livox_ros_driver/CustomMsg. A point's time is header.stamp + offset_time: the stamp is what clock
/// corrections rewrite, `timebase` stays on the sensor's own clock.
std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/PointCloud2 with x, y, z and, where there are, intensity or reflectivity and a time of each point, in
/// whatever order, type and byte order.
std::optional<DecodedMessage> decode_point_cloud(const RawMessage& message, const DecodeOptions& options);
/// geometry_msgs/QuaternionStamped.
std::optional<DecodedMessage> decode_quaternion(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/Imu, its orientation; empty where the message says that it has none (covariance[0] = -1).
std::optional<DecodedMessage> decode_imu_attitude(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/NavSatFix; empty where the receiver has no fix.
std::optional<DecodedMessage> decode_fix(const RawMessage& message, const DecodeOptions& options);
/// geometry_msgs/PointStamped: metres.
std::optional<DecodedMessage> decode_point(const RawMessage& message, const DecodeOptions& options);
/// geometry_msgs/PoseStamped, nav_msgs/Odometry, geometry_msgs/TransformStamped (whatever its frames) and
/// tf2_msgs/TFMessage (empty where `options.frames` are not in it; a transform the other way round is inverted).
std::optional<DecodedMessage> decode_pose_attitude(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_pose_position(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_odometry_attitude(const RawMessage& message,
                                                       const DecodeOptions& options);
std::optional<DecodedMessage> decode_odometry_position(const RawMessage& message,
                                                       const DecodeOptions& options);
std::optional<DecodedMessage> decode_transform_attitude(const RawMessage& message,
                                                        const DecodeOptions& options);
std::optional<DecodedMessage> decode_transform_position(const RawMessage& message,
                                                        const DecodeOptions& options);
std::optional<DecodedMessage> decode_tf_attitude(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_tf_position(const RawMessage& message, const DecodeOptions& options);
/// (parent, child) of the transforms of a tf2_msgs/TFMessage. @throws DecodeError
std::vector<std::pair<std::string, std::string>> transform_frames(const RawMessage& message);
/// std_msgs/Float32 as a height; it has no stamp, its time is the receive time.
std::optional<DecodedMessage> decode_float_height(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/CameraInfo; empty where the camera is not calibrated (K is zero).
std::optional<DecodedMessage> decode_camera_info(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
