#include "sensors/messages/livox_decoder.hpp"

#include <algorithm>

#include "sensors/messages/lidar_points.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/messages/point_times.hpp"

namespace alight {

namespace {

using NoiseRule = bool (*)(std::uint8_t tag, NoisePoints noise);

int two_bits(std::uint8_t tag, int first) { return (tag >> first) & 3; }

LidarReturn read_point(ByteReader& reader, std::int64_t stamp_ns, const DecodeOptions& options,
                       std::uint8_t& tag) {
  LidarReturn point;
  point.t_ns = stamp_ns + reader.read<std::uint32_t>();
  for (int axis = 0; axis < 3; ++axis) point.p_lidar[axis] = reader.read<float>();
  point.reflectivity = scaled_reflectivity(reader.read<std::uint8_t>(), options.reflectivity_scale);
  tag = reader.read<std::uint8_t>();
  reader.take(1);  // line
  return point;
}

LidarPacket read_packet(const RawMessage& message, const DecodeOptions& options, NoiseRule is_noise) {
  ByteReader reader(message);
  LidarPacket out;
  const MessageHeader header = reader.read_header();
  out.t_ns = options.stamp == StampSource::kHeader ? header.stamp_ns : message.receive_ns;
  out.frame_id = header.frame_id;
  reader.read<std::uint64_t>();  // timebase
  const auto point_num = reader.read<std::uint32_t>();
  out.lidar_id = reader.read<std::uint8_t>();
  reader.take(3);  // rsvd
  const auto count = reader.read<std::uint32_t>();
  if (point_num != count) {
    throw DecodeError("point_num is " + std::to_string(point_num) + ", but " + std::to_string(count) +
                      " points follow");
  }
  if (std::uint64_t{count} * livox_ros_driver::kCustomPointBytes != reader.left()) {
    throw DecodeError(std::to_string(count) + " points announced, but " + std::to_string(reader.left()) +
                      " bytes of points there");
  }
  out.returns.reserve(count);
  std::int64_t last_ns = out.t_ns;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint8_t tag = 0;
    const LidarReturn point = read_point(reader, out.t_ns, options, tag);
    if (!is_echo(point.p_lidar, options)) {
      ++out.dropped;
    } else if (is_noise(tag, options.noise)) {
      ++out.noise;
    } else {
      out.returns.push_back(point);
      last_ns = std::max(last_ns, point.t_ns);
    }
  }
  const std::int64_t begin_ns = scan_begin_ns(out.t_ns, options.points, last_ns - out.t_ns);
  for (LidarReturn& point : out.returns) point.t_ns += begin_ns - out.t_ns;
  return out;
}

}  // namespace

bool is_noise_of_livox(std::uint8_t tag, NoisePoints noise) {
  if (noise == NoisePoints::kKeep) return false;
  const int least = noise == NoisePoints::kDropCertain ? 1 : 2;  // 1 is surer than 2
  const int place = two_bits(tag, 0), intensity = two_bits(tag, 2);
  return (place >= 1 && place <= least) || (intensity >= 1 && intensity <= least);
}

bool is_noise_of_livox2(std::uint8_t tag, NoisePoints noise) {
  if (noise == NoisePoints::kKeep) return false;
  const int least = noise == NoisePoints::kDropCertain ? 2 : 1;  // 2 is less trusted than 1
  for (const int first : {0, 2, 4}) {
    const int confidence = two_bits(tag, first);
    if (confidence >= least && confidence <= 2) return true;
  }
  return false;
}

std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options) {
  return read_packet(message, options, is_noise_of_livox);
}

std::optional<DecodedMessage> decode_livox2(const RawMessage& message, const DecodeOptions& options) {
  return read_packet(message, options, is_noise_of_livox2);
}

}  // namespace alight
