#include "dataset/message_assembler.hpp"

#include <utility>

namespace alight {

MessageAssembler::MessageAssembler(const Rig& rig, const LogConfig& config)
    : rig_(rig), config_(config), pairer_(to_nanoseconds(config.stereo_pair_tolerance_s)) {}

void MessageAssembler::add(Sensor sensor, const Decoder& decoder, const RawMessage& raw) {
  std::optional<DecodedMessage> decoded = decoder.decode(raw, options_of(sensor));
  if (!decoded) {
    ++dropped_[std::string(name(sensor)) + " messages without a measurement"];
    return;
  }
  accept(sensor, std::move(*decoded));
}

DecodeOptions MessageAssembler::options_of(Sensor sensor) const {
  DecodeOptions options;
  options.min_range_m = config_.min_range_m;
  options.max_range_m = config_.max_range_m;
  options.frames = {config_.tf_world_frame, config_.tf_body_frame};
  if (sensor == Sensor::kLeft) options.stamp = rig_.cam0.stamp;
  if (sensor == Sensor::kRight) options.stamp = rig_.cam1->stamp;
  if (sensor == Sensor::kAttitude) options.stamp = config_.attitude_stamp;
  if (sensor == Sensor::kPosition) options.stamp = config_.position_stamp;
  if (sensor == Sensor::kLidar) {
    options.stamp = rig_.lidar0->stamp;
    options.points = rig_.lidar0->points;
    options.reflectivity_scale = rig_.lidar0->reflectivity_scale;
  }
  return options;
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
    accept_timed(*attitude, config_.attitude_timeshift_s);
  } else if (auto* position = std::get_if<PositionSample>(&decoded)) {
    accept_timed(*position, config_.position_timeshift_s);
  } else {
    accept_timed(std::get<HeightSample>(decoded), config_.height_timeshift_s);
  }
}

template <class Sample>
void MessageAssembler::accept_timed(Sample sample, double timeshift_s) {
  sample.t_ns += to_nanoseconds(timeshift_s);
  ready_.emplace_back(std::move(sample));
}

/// The eyes are triggered together, so they are paired by the stamps as recorded, where the configuration knows of no
/// difference between their clocks; the frame's time is the left eye's.
void MessageAssembler::accept_image(Sensor sensor, CameraImage image) {
  require_size(image);
  if (sensor == Sensor::kRight) image.t_ns -= to_nanoseconds(config_.right_stamp_lead_s);
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
