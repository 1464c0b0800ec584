#include "dataset/message_assembler.hpp"

#include <utility>

namespace alight {

MessageAssembler::MessageAssembler(const Rig& rig, const LogConfig& config)
    : rig_(rig),
      options_{config.min_range_m, config.max_range_m},
      pairer_(to_nanoseconds(config.stereo_pair_tolerance_s)) {}

void MessageAssembler::add(Sensor sensor, const Decoder& decoder, const RawMessage& raw) {
  std::optional<DecodedMessage> decoded = decoder.decode(raw, options_);
  if (!decoded) {
    ++dropped_[std::string(name(sensor)) + " messages without a measurement"];
    return;
  }
  accept(sensor, std::move(*decoded));
}

std::optional<LogMessage> MessageAssembler::take() {
  if (ready_.empty()) return std::nullopt;
  LogMessage message = std::move(ready_.front());
  ready_.pop_front();
  return message;
}

void MessageAssembler::require_size(const CameraImage& image) const {
  const cv::Size wanted = rig_.cam0.camera.intrinsics.size();
  if (wanted.empty() || image.image.size() == wanted) return;  // a rig whose cameras are not calibrated yet
  throw DecodeError("image of " + std::to_string(image.image.cols) + "x" + std::to_string(image.image.rows) +
                    " pixels, but the rig's camera has " + std::to_string(wanted.width) + "x" +
                    std::to_string(wanted.height));
}

void MessageAssembler::accept(Sensor sensor, DecodedMessage decoded) {
  if (auto* image = std::get_if<CameraImage>(&decoded)) return accept_image(sensor, std::move(*image));
  if (auto* packet = std::get_if<LidarPacket>(&decoded)) return accept_packet(std::move(*packet));
  if (auto* attitude = std::get_if<AttitudeSample>(&decoded)) {
    ready_.emplace_back(*attitude);
  } else if (auto* position = std::get_if<PositionSample>(&decoded)) {
    ready_.emplace_back(*position);
  } else {
    ready_.emplace_back(std::get<HeightSample>(decoded));
  }
}

/// The eyes are triggered together, so they are paired by the stamps as recorded; the frame's time is the
/// left eye's.
void MessageAssembler::accept_image(Sensor sensor, CameraImage image) {
  require_size(image);
  std::optional<StereoFrame> frame;
  if (!rig_.cam1) {
    frame = StereoFrame{image.t_ns, std::move(image.image), {}};
  } else {
    frame =
        sensor == Sensor::kLeft ? pairer_.add_left(std::move(image)) : pairer_.add_right(std::move(image));
  }
  if (!frame) return;
  frame->t_ns += to_nanoseconds(rig_.cam0.timeshift_cam_imu_s);
  ready_.emplace_back(std::move(*frame));
}

void MessageAssembler::accept_packet(LidarPacket packet) {
  const std::int64_t shift_ns = to_nanoseconds(rig_.lidar0->timeshift_s);
  packet.t_ns += shift_ns;
  for (LidarReturn& point : packet.returns) point.t_ns += shift_ns;
  if (packet.dropped > 0) dropped_["LiDAR points without echo or out of range"] += packet.dropped;
  ready_.emplace_back(std::move(packet));
}

}  // namespace alight
