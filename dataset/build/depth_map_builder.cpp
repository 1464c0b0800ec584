#include "dataset/build/depth_map_builder.hpp"

#include <algorithm>
#include <limits>
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
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min() / 2;

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

DepthMapBuilder::DepthMapBuilder(const Rig& rig, const DepthMapConfig& config, PointPose point_pose)
    : config_(config),
      point_pose_(point_pose),
      rectifier_(rig),
      crop_(crop_of(rectifier_.rig(), config.crop_px)),
      cropped_(crop(rectifier_.rig(), crop_)),
      T_imu_lidar_(cropped_.T_camera_imu.inverse() * cropped_.T_camera_lidar),
      before_ns_(to_nanoseconds(config.window_before_s)),
      after_ns_(to_nanoseconds(config.window_after_s)),
      trajectory_(config.max_pose_gap_s),
      last_frame_ns_(kNever),
      placed_until_ns_(kNever),
      clock_ns_(kNever) {}

void DepthMapBuilder::add(LogMessage message) {
  if (auto* frame = std::get_if<StereoFrame>(&message)) {
    add_frame(std::move(*frame));
  } else if (auto* packet = std::get_if<LidarPacket>(&message)) {
    add_packet(std::move(*packet));
  } else if (const auto* attitude = std::get_if<AttitudeSample>(&message)) {
    tick(attitude->t_ns);
    if (!trajectory_.add(*attitude)) ++dropped_["attitudes not later than the one before"];
  } else if (const auto* position = std::get_if<PositionSample>(&message)) {
    tick(position->t_ns);
    if (!trajectory_.add(*position)) ++dropped_["positions not later than the one before"];
  } else {
    heights_.add(std::get<HeightSample>(message));
  }
}

void DepthMapBuilder::add_frame(StereoFrame frame) {
  if (frame.t_ns <= last_frame_ns_) {
    ++dropped_["images not later than the one before"];
    return;
  }
  last_frame_ns_ = frame.t_ns;
  tick(frame.t_ns);
  frames_.push_back(std::move(frame));
}

void DepthMapBuilder::add_packet(LidarPacket packet) {
  std::int64_t last_ns = packet.t_ns;
  for (const LidarReturn& point : packet.returns) last_ns = std::max(last_ns, point.t_ns);
  tick(last_ns);
  packets_.push_back({last_ns, std::move(packet)});
}

std::optional<BuiltSample> DepthMapBuilder::next() {
  place_packets();
  while (!frames_.empty() && frame_is_ready(frames_.front().t_ns)) {
    StereoFrame frame = std::move(frames_.front());
    frames_.pop_front();
    if (auto sample = build(std::move(frame))) return sample;
  }
  forget();
  return std::nullopt;
}

void DepthMapBuilder::place_packets() {
  const auto poses_end_ns = trajectory_.trajectory().end_ns().value_or(kNever);
  while (!packets_.empty()) {
    const WaitingPacket& front = packets_.front();
    if (!finished_ && poses_end_ns < front.last_ns && clock_ns_ < front.last_ns + kMaxWaitNs) return;
    placed_until_ns_ = std::max(placed_until_ns_, front.last_ns);
    if (point_pose_ == PointPose::kOwnTime) {
      AlignedPoints aligned = align_points(front.packet.returns, trajectory_.trajectory(), T_imu_lidar_);
      if (aligned.without_pose > 0) dropped_["LiDAR points without a pose"] += aligned.without_pose;
      window_.add(std::move(aligned.points));
    } else {
      std::vector<WorldPoint>
          points;  // in the IMU frame: the pose at image time cancels out of the projection
      for (const LidarReturn& point : front.packet.returns) {
        points.push_back({point.t_ns, T_imu_lidar_ * point.p_lidar.cast<double>()});
      }
      window_.add(std::move(points));
    }
    packets_.pop_front();
  }
}

bool DepthMapBuilder::frame_is_ready(std::int64_t t_ns) const {
  if (finished_ || clock_ns_ >= t_ns + after_ns_ + kMaxWaitNs) return true;
  const auto poses_end_ns = trajectory_.trajectory().end_ns().value_or(kNever);
  return poses_end_ns >= t_ns && placed_until_ns_ >= t_ns + after_ns_;
}

std::optional<BuiltSample> DepthMapBuilder::build(StereoFrame frame) {
  const auto T_world_imu = trajectory_.trajectory().T_world_imu(frame.t_ns);
  if (!T_world_imu) {
    ++dropped_["images without a pose"];
    return std::nullopt;
  }
  BuiltSample sample;
  sample.t_ns = frame.t_ns;
  sample.T_world_camera = *T_world_imu * cropped_.T_camera_imu.inverse();
  const Eigen::Isometry3d T_camera_points =
      point_pose_ == PointPose::kOwnTime ? sample.T_world_camera.inverse() : cropped_.T_camera_imu;
  sample.sparse = SparseDepth::empty(cropped_.intrinsics.size());
  sample.points =
      window_.project(frame.t_ns - before_ns_, frame.t_ns + after_ns_, T_camera_points, cropped_.intrinsics,
                      frame.t_ns, {config_.min_depth_m, config_.max_depth_m}, sample.sparse);
  if (sample.sparse.count() < config_.min_pixels) {
    ++dropped_["images with too few depth pixels"];
    return std::nullopt;
  }
  sample.height_m = heights_.at(frame.t_ns);
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
  if (clock_ns_ == kNever) return;
  const std::int64_t oldest_image_ns = std::max(frames_.empty() ? last_frame_ns_ : frames_.front().t_ns,
                                                clock_ns_ - after_ns_ - kMaxWaitNs - kMaxLatencyNs);
  window_.forget_before(oldest_image_ns - before_ns_);
  trajectory_.forget_before(clock_ns_ - after_ns_ - kMaxWaitNs - 2 * kMaxLatencyNs);
  heights_.forget_before(clock_ns_ - after_ns_ - kMaxWaitNs - 2 * kMaxLatencyNs);
}

}  // namespace alight
