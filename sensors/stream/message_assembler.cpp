#include "sensors/stream/message_assembler.hpp"

#include <utility>

namespace alight {

MessageAssembler::MessageAssembler(const Rig& rig, const LogConfig& config)
    : rig_(rig),
      config_(config),
      pairer_(to_nanoseconds(config.stereo_pair_tolerance_s)),
      one_lidar_(rig.lidar0 ? rig.lidar0->lidar_id : std::nullopt) {}

void MessageAssembler::add(Sensor sensor, const Decoder& decoder, const RawMessage& raw) {
  // A height has no stamp: the same one again is nothing unusual.
  if (sensor != Sensor::kHeight && repeat_guards_[sensor].repeated(raw)) {
    ++dropped_[std::string(name(sensor)) + " messages that came twice"];
    return;
  }
  if (decoder.role == LogRole::kImage) return add_image(sensor, decoder, raw);
  std::optional<DecodedMessage> decoded =
      decoder.decode(raw, sensor == Sensor::kLidar ? lidar_options() : options_of(sensor));
  if (!decoded) {
    ++dropped_[std::string(name(sensor)) + " messages without a measurement"];
    return;
  }
  accept(sensor, std::move(*decoded), raw.receive_ns);
}

bool MessageAssembler::stamp_is_usable(Sensor sensor, std::int64_t t_ns, std::int64_t receive_ns) {
  if (stamp_guards_[sensor].usable(t_ns, receive_ns)) return true;
  ++dropped_[std::string(name(sensor)) + " messages whose stamp jumps"];
  return false;
}

void MessageAssembler::look_ahead(const Decoder& decoder, const RawMessage& raw) {
  try {
    decoder.decode(raw, lidar_options());
  } catch (const DecodeError&) {
    // Said when the message is read.
  }
}

DecodeOptions MessageAssembler::lidar_options() {
  DecodeOptions options = options_of(Sensor::kLidar);
  options.point_times = &point_times_;
  return options;
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
    options.noise = rig_.lidar0->noise_points;
  }
  return options;
}

std::optional<LogMessage> MessageAssembler::take() {
  if (ready_.empty()) return std::nullopt;
  LogMessage message = std::move(ready_.front());
  ready_.pop_front();
  return message;
}

void MessageAssembler::accept(Sensor sensor, DecodedMessage decoded, std::int64_t receive_ns) {
  const std::int64_t t_ns = std::visit([](const auto& message) { return message.t_ns; }, decoded);
  if (!stamp_is_usable(sensor, t_ns, receive_ns)) return;
  if (auto* packet = std::get_if<LidarPacket>(&decoded)) return accept_packet(std::move(*packet));
  if (auto* attitude = std::get_if<AttitudeSample>(&decoded)) {
    attitude_guard_.check(*attitude);
    accept_timed(*attitude, config_.attitude_timeshift_s);
  } else if (auto* position = std::get_if<PositionSample>(&decoded)) {
    accept_position(*position);
  } else {
    accept_timed(std::get<HeightSample>(decoded), config_.height_timeshift_s);
  }
}

template <class Sample>
void MessageAssembler::accept_timed(Sample sample, double timeshift_s) {
  sample.t_ns += to_nanoseconds(timeshift_s);
  ready_.emplace_back(std::move(sample));
}

/// The cameras are triggered together, so they are paired by the stamps as recorded, where the configuration knows of no
/// difference between their clocks.
void MessageAssembler::add_image(Sensor sensor, const Decoder& decoder, const RawMessage& raw) {
  ByteReader reader(raw);
  UndecodedImage image{
      read_stamp(reader, raw, options_of(sensor)), &decoder, {raw.data, raw.data + raw.size}, raw.receive_ns};
  if (!stamp_is_usable(sensor, image.t_ns, raw.receive_ns)) return;
  if (!rig_.cam1) return accept_frame({std::move(image), std::nullopt});
  if (sensor == Sensor::kRight) image.t_ns -= to_nanoseconds(config_.right_stamp_lead_s);
  auto pair =
      sensor == Sensor::kLeft ? pairer_.add_left(std::move(image)) : pairer_.add_right(std::move(image));
  if (pair) accept_frame({std::move(pair->first), std::move(pair->second)});
}

/// The frame's time is the left camera's.
void MessageAssembler::accept_frame(UndecodedFrame undecoded) {
  if (frames_seen_++ % every_nth_image_ != 0) {
    ++dropped_["images left out by every_nth_image"];
    return;
  }
  StereoFrame frame;
  frame.t_ns = undecoded.left.t_ns + to_nanoseconds(rig_.cam0.timeshift_cam_imu_s);
  frame.undecoded = std::make_shared<const UndecodedFrame>(std::move(undecoded));
  if (decodes_) decode(frame);
  ready_.emplace_back(std::move(frame));
}

void MessageAssembler::decode(StereoFrame& frame) const {
  frame.left = decode(Sensor::kLeft, frame.undecoded->left);
  if (frame.undecoded->right) frame.right = decode(Sensor::kRight, *frame.undecoded->right);
  frame.undecoded.reset();
}

cv::Mat MessageAssembler::decode(Sensor sensor, const UndecodedImage& image) const {
  try {
    const auto decoded =
        image.decoder->decode({image.bytes.data(), image.bytes.size(), image.receive_ns}, options_of(sensor));
    cv::Mat pixels = std::get<CameraImage>(decoded.value()).image;
    const cv::Size wanted = rig_.cam0.camera.intrinsics.size();
    if (wanted.empty() || pixels.size() == wanted)
      return pixels;  // empty: a rig whose cameras are not calibrated yet
    throw DecodeError("image of " + std::to_string(pixels.cols) + "x" + std::to_string(pixels.rows) +
                      " pixels, but the rig's camera has " + std::to_string(wanted.width) + "x" +
                      std::to_string(wanted.height));
  } catch (const DecodeError& e) {
    throw DecodeError(std::string(name(sensor)) + ": " + e.what());
  }
}

void MessageAssembler::accept_position(const PositionSample& position) {
  for (const PositionSample& sample : fix_guard_.add(position))
    accept_timed(sample, config_.position_timeshift_s);
  if (fix_guard_.left_out() > 0)
    dropped_["satellite fixes that the others do not bear out"] = fix_guard_.left_out();
}

void MessageAssembler::accept_packet(LidarPacket packet) {
  if (!one_lidar_.wanted(packet)) {
    ++dropped_["LiDAR messages of another lidar_id"];
    return;
  }
  const std::int64_t mistimed = point_time_guard_.clean(packet);
  if (mistimed > 0) dropped_["LiDAR points whose times cannot be true"] += mistimed;
  if (packet.noise > 0) dropped_["LiDAR points that the sensor marks as noise"] += packet.noise;
  const std::int64_t shift_ns = to_nanoseconds(rig_.lidar0->timeshift_s);
  packet.t_ns += shift_ns;
  for (LidarReturn& point : packet.returns) point.t_ns += shift_ns;
  if (packet.dropped > 0) dropped_["LiDAR points without echo or out of range"] += packet.dropped;
  ready_.emplace_back(std::move(packet));
}

}  // namespace alight
