#include "sensors/messages/livox_decoder.hpp"

#include <algorithm>

#include "sensors/messages/lidar_points.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/messages/point_times.hpp"

namespace alight {

std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  LidarPacket out;
  out.t_ns = read_stamp(reader, message, options);
  reader.read<std::uint64_t>();  // timebase
  const auto point_num = reader.read<std::uint32_t>();
  reader.take(4);  // lidar_id, rsvd
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
  std::int64_t longest_ns = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    LidarReturn point;
    const std::int64_t offset_ns = reader.read<std::uint32_t>();
    point.t_ns = out.t_ns + offset_ns;
    for (int axis = 0; axis < 3; ++axis) point.p_lidar[axis] = reader.read<float>();
    point.reflectivity = scaled_reflectivity(reader.read<std::uint8_t>(), options.reflectivity_scale);
    reader.take(2);  // tag, line
    longest_ns = std::max(longest_ns, offset_ns);
    if (is_echo(point.p_lidar, options)) out.returns.push_back(point);
  }
  const std::int64_t begin_ns = scan_begin_ns(out.t_ns, options.points, longest_ns);
  for (LidarReturn& point : out.returns) point.t_ns += begin_ns - out.t_ns;
  out.dropped = static_cast<std::int64_t>(count) - static_cast<std::int64_t>(out.returns.size());
  return out;
}

}  // namespace alight
