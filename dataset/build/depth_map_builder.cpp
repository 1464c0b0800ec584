#include "dataset/build/depth_map_builder.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "foundation/config_reader.hpp"
#include "geometry/crop.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

/// How long a packet or image waits for data that may never come (a sensor that died), in time of the log.
constexpr std::int64_t kMaxWaitNs = 2 * kNanosecondsPerSecond;
/// A message describes a time this much before it arrives, at most.
constexpr std::int64_t kMaxLatencyNs = kNanosecondsPerSecond;

cv::Rect crop_of(const RectifiedRig& rig, const std::optional<int>& crop_px) {
  const cv::Size image = rig.intrinsics.size();
  if (!crop_px) return {{0, 0}, image};
  if (*crop_px > image.width || *crop_px > image.height) {
    throw ConfigError("depth_map.crop_px: " + std::to_string(*crop_px) +
                      " does not fit into the rig's image of " + std::to_string(image.width) + "x" +
                      std::to_string(image.height) + " pixels");
  }
  return centre_crop(image, {*crop_px, *crop_px});
}

}  // namespace

void bind(Binder& b, DepthMapConfig& c) {
  b.field("crop_px", c.crop_px, "side of the centred square that is kept, none: the whole image",
          at_least(16));
  b.field("window_before_s", c.window_before_s, "LiDAR points measured up to this long before the image",
          at_least(0));
  b.field("window_after_s", c.window_after_s, "and after it", at_least(0));
  b.field("every_nth_image", c.every_nth_image, "images between the ones that are kept, plus one",
          at_least(1));
  b.field("min_depth_m", c.min_depth_m, "nearer points are dropped", positive());
  b.field("max_depth_m", c.max_depth_m, "farther points are dropped (16 bits on disk end at 256 m)",
          between(0.1, 255));
  b.field("max_pose_gap_s", c.max_pose_gap_s, "poses are not interpolated across longer gaps", positive());
  b.field("min_pixels", c.min_pixels, "images with fewer depth pixels are dropped", at_least(0));
  b.check("max_depth_m", c.max_depth_m > c.min_depth_m, "must be larger than min_depth_m");
  b.check("window_after_s", c.window_before_s + c.window_after_s > 0, "the window is empty");
  b.check("window_after_s", c.window_before_s <= 30 && c.window_after_s <= 30,
          "offsets on disk are 16 bits of milliseconds: 30 s at most on either side");
}

DepthMapBuilder::DepthMapBuilder(const Rig& rig, const DepthMapConfig& config)
    : config_(config),
      rectifier_(rig),
      crop_(crop_of(rectifier_.rig(), config.crop_px)),
      cropped_(crop(rectifier_.rig(), crop_)),
      before_ns_(to_nanoseconds(config.window_before_s)),
      after_ns_(to_nanoseconds(config.window_after_s)),
      aligner_({config.max_pose_gap_s, to_seconds(kMaxWaitNs)},
               cropped_.T_camera_imu.inverse() * cropped_.T_camera_lidar) {}

void DepthMapBuilder::add(LogMessage message) {
  if (auto* frame = std::get_if<StereoFrame>(&message)) {
    add_frame(std::move(*frame));
  } else if (auto* packet = std::get_if<LidarPacket>(&message)) {
    aligner_.add(std::move(*packet));
  } else if (const auto* attitude = std::get_if<AttitudeSample>(&message)) {
    aligner_.add(*attitude);
  } else if (const auto* position = std::get_if<PositionSample>(&message)) {
    aligner_.add(*position);
  } else {
    aligner_.add(std::get<HeightSample>(message));
  }
}

void DepthMapBuilder::add_frame(StereoFrame frame) {
  if (last_frame_ns_ && frame.t_ns <= *last_frame_ns_)
    return aligner_.drop("images not later than the one before");
  last_frame_ns_ = frame.t_ns;
  aligner_.saw(frame.t_ns);
  frames_.push_back(std::move(frame));
}

std::optional<BuiltSample> DepthMapBuilder::next() {
  while (auto packet = aligner_.next()) window_.add(std::make_shared<WorldPacket>(std::move(*packet)));
  while (!frames_.empty() && frame_is_ready(frames_.front().t_ns)) {
    StereoFrame frame = std::move(frames_.front());
    frames_.pop_front();
    if (auto sample = build(std::move(frame))) return sample;
  }
  forget();
  return std::nullopt;
}

bool DepthMapBuilder::frame_is_ready(std::int64_t t_ns) const {
  const std::int64_t window_end_ns = t_ns + after_ns_;
  const bool points_there = aligner_.finished() || aligner_.placed_until_ns() >= window_end_ns;
  return (aligner_.settled(t_ns) && points_there) || aligner_.late(window_end_ns);
}

std::optional<BuiltSample> DepthMapBuilder::build(StereoFrame frame) {
  const auto T_world_imu = aligner_.T_world_imu(frame.t_ns);
  if (!T_world_imu) {
    aligner_.drop("images without a pose");
    return std::nullopt;
  }
  BuiltSample sample;
  sample.t_ns = frame.t_ns;
  sample.T_world_camera = *T_world_imu * cropped_.T_camera_imu.inverse();
  sample.sparse = SparseDepth::empty(cropped_.intrinsics.size());
  sample.points = window_.project(frame.t_ns - before_ns_, frame.t_ns + after_ns_,
                                  sample.T_world_camera.inverse(), cropped_.intrinsics, frame.t_ns,
                                  {config_.min_depth_m, config_.max_depth_m}, sample.sparse);
  if (sample.sparse.count() < config_.min_pixels) {
    aligner_.drop("images with too few depth pixels");
    return std::nullopt;
  }
  sample.height_m = aligner_.heights().at(frame.t_ns);
  if (frame.undecoded) {
    sample.frame = std::move(frame);
  } else {
    add_images(sample, frame);
  }
  return sample;
}

void DepthMapBuilder::add_images(BuiltSample& sample, const StereoFrame& frame) const {
  sample.left = rectifier_.rectify_left(frame.left)(crop_).clone();
  if (!frame.right.empty()) sample.right = rectifier_.rectify_right(frame.right)(crop_).clone();
}

/// What no coming image or packet can ask for any more.
void DepthMapBuilder::forget() {
  const auto now_ns = aligner_.now_ns();
  if (!now_ns) return;
  const std::int64_t oldest_waiting_ns = *now_ns - after_ns_ - kMaxWaitNs - kMaxLatencyNs;
  const std::int64_t oldest_image_ns =
      frames_.empty() ? last_frame_ns_.value_or(oldest_waiting_ns) : frames_.front().t_ns;
  window_.forget_before(std::max(oldest_image_ns, oldest_waiting_ns) - before_ns_);
  aligner_.forget_before(oldest_waiting_ns - kMaxLatencyNs);
}

}  // namespace alight
