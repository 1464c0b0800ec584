// A LiDAR driver's own message type: a function that decodes it, and a row in the table of decoders. From then on logs
// and live topics of that type are read wherever the rig names their topic.
#include <cstdio>

#include <alight/sensors/messages/decoders.hpp>
#include <alight/sensors/messages/lidar_points.hpp>

namespace {

/// acme_msgs/Sweep: Header header, and points of {uint32 offset_us, int16 x_mm, int16 y_mm, int16 z_mm}.
std::optional<alight::DecodedMessage> decode_sweep(const alight::RawMessage& message,
                                                   const alight::DecodeOptions& options) {
  alight::ByteReader reader(message);
  alight::LidarPacket packet;
  packet.t_ns = alight::read_stamp(reader, message, options);
  for (auto left = reader.read<std::uint32_t>(); left > 0; --left) {
    alight::LidarReturn point;
    point.t_ns = packet.t_ns + 1000 * std::int64_t{reader.read<std::uint32_t>()};
    for (int axis = 0; axis < 3; ++axis) point.p_lidar[axis] = 1e-3F * reader.read<std::int16_t>();
    if (alight::is_echo(point.p_lidar, options)) packet.returns.push_back(point);
  }
  reader.expect_end();
  return packet;
}

}  // namespace

int main() {
  const char* md5 = "0123456789abcdef0123456789abcdef";  // of the driver's message definition
  alight::add_decoder({"acme_msgs/Sweep", md5, alight::LogRole::kLidar, decode_sweep});
  std::printf("LiDAR: %s\n", alight::accepted_types(alight::LogRole::kLidar).c_str());
  // Second 9, a point 1 m ahead.
  const std::uint8_t bytes[] = {0, 0, 0, 0, 9, 0, 0, 0, 0, 0,    0, 0, 0, 0, 0,
                                0, 1, 0, 0, 0, 5, 0, 0, 0, 0xe8, 3, 0, 0, 0, 0};
  const alight::Decoder& row = *alight::find_decoder(alight::LogRole::kLidar, "acme_msgs/Sweep");
  const auto decoded = row.decode({bytes, sizeof bytes, 0}, {});
  const auto& packet = std::get<alight::LidarPacket>(*decoded);
  std::printf("%zu point, %.2f m ahead\n", packet.returns.size(), packet.returns.at(0).p_lidar.x());
}
