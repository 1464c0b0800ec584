#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/rig/noise_points.hpp"
#include "geometry/rig/point_timing.hpp"
#include "sensors/messages/byte_reader.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/messages/point_times.hpp"

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
  NoisePoints noise = NoisePoints::kDropLikely;
  TransformFrames frames;
  PointTimeMemory* point_times = nullptr;  ///< of the LiDAR's topic
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

}  // namespace alight
