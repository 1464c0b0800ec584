#include <cmath>

#include "dataset/messages/decoders.hpp"
#include "dataset/messages/livox_custom_msg.hpp"

namespace alight {
namespace {

/// "No return" is (0, 0, 0): nearer than any limit.
bool is_echo(const Eigen::Vector3f& p_lidar, const DecodeOptions& options) {
  const double range_m = p_lidar.cast<double>().norm();
  return std::isfinite(range_m) && range_m > 0 && range_m >= options.min_range_m &&
         range_m <= options.max_range_m;
}

}  // namespace

std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  LidarPacket out;
  out.t_ns = reader.read_header();
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
  for (std::uint32_t i = 0; i < count; ++i) {
    LidarReturn point;
    point.t_ns = out.t_ns + reader.read<std::uint32_t>();
    for (int axis = 0; axis < 3; ++axis) point.p_lidar[axis] = reader.read<float>();
    point.reflectivity = reader.read<std::uint8_t>();
    reader.take(2);  // tag, line
    if (is_echo(point.p_lidar, options)) out.returns.push_back(point);
  }
  out.dropped = static_cast<std::int64_t>(count) - static_cast<std::int64_t>(out.returns.size());
  return out;
}

}  // namespace alight
