#include "infer/health/health_monitor.hpp"

#include <algorithm>
#include <utility>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kPoseKept_s = 2.0;
constexpr double kLongestHold_s =
    0.2;  // a packet without a pose is passed on unjudged; the engine has its own rules
constexpr double kHeightAge_s = 0.5;

std::int64_t last_stamp(const LidarPacket& packet) {
  std::int64_t last_ns = packet.t_ns;
  for (const LidarReturn& echo : packet.returns) last_ns = std::max(last_ns, echo.t_ns);
  return last_ns;
}

}  // namespace

HealthMonitor::HealthMonitor(const HealthConfig& config, const Rig& rig, DepthMakers makers)
    : config_(config),
      makers_(makers),
      expects_right_(rig.cam1.has_value()),
      rectifier_(rig),
      left_(config, "left camera"),
      right_(config, "right camera"),
      alignment_(config, rectifier_.rig()),
      lidar_(config, rectifier_.rig().T_camera_imu.inverse() * rectifier_.rig().T_camera_lidar),
      pose_(config) {
  for (int i = 0; i < kStreams; ++i) {
    const auto s = static_cast<Stream>(i);
    streams_.emplace_back(config, s, s != Stream::kHeight);
  }
}

std::vector<LogMessage> HealthMonitor::add(const LogMessage& message) {
  Passed passed;
  std::visit([&](const auto& typed) { receive(typed, passed); }, message);
  release_packets(false, passed);
  return passed;
}

std::vector<LogMessage> HealthMonitor::finish() {
  Passed passed;
  release_packets(true, passed);
  return passed;
}

bool HealthMonitor::believe(Stream s, std::int64_t t_ns) {
  clock_.saw(s, t_ns);
  const std::int64_t now_ns = *clock_.now_ns();
  if (!begin_ns_) begin_ns_ = now_ns;
  // Where slow sensors alone set the clock, it lags by as much as they are slow.
  double slack_s = 0;
  if (!stream(Stream::kAttitude).usable() || !stream(Stream::kPosition).usable()) {
    for (const StreamWatch& other : streams_) slack_s = std::max(slack_s, other.period_s());
  }
  const bool believed = stream(s).add(t_ns, now_ns, slack_s);
  pass_time(now_ns);
  return believed;
}

void HealthMonitor::pass_time(std::int64_t now_ns) {
  now_ns_ = std::max(now_ns_, now_ns);
  for (StreamWatch& watch : streams_) watch.pass(now_ns_, *begin_ns_);
}

void HealthMonitor::receive(const StereoFrame& frame, Passed& passed) {
  if (!believe(Stream::kCamera, frame.t_ns)) return;
  StereoFrame fit = frame;
  if (!left_.add(frame.t_ns, frame.left, pose_.p_world())) fit.left = cv::Mat();
  const bool right =
      (!frame.right.empty() || expects_right_) && right_.add(frame.t_ns, frame.right, pose_.p_world());
  if (!fit.left.empty() && right) judge_cameras(frame);
  if (!right || !alignment_.usable() || fit.left.empty()) fit.right = cv::Mat();
  passed.emplace_back(std::move(fit));
}

void HealthMonitor::judge_cameras(const StereoFrame& frame) {
  if (!alignment_.due(frame.t_ns)) return;
  alignment_.add(frame.t_ns, rectifier_.rectify_left(frame.left), rectifier_.rectify_right(frame.right),
                 ground_distance_m());
}

std::optional<double> HealthMonitor::ground_distance_m() const {
  if (stream(Stream::kLidar).usable() && lidar_.distance_m()) return lidar_.distance_m();
  const bool fresh = height_ && to_seconds(now_ns_ - height_->t_ns) < kHeightAge_s;
  return fresh ? std::optional<double>(height_->height_m) : std::nullopt;
}

void HealthMonitor::receive(const LidarPacket& packet, Passed&) {
  if (believe(Stream::kLidar, last_stamp(packet))) waiting_.push_back(packet);
}

/// Released before the pose message that settles them, so that the engine sees them in the order in which they came.
void HealthMonitor::release_packets(bool all, Passed& passed) {
  Passed packets;
  while (!waiting_.empty()) {
    const std::int64_t end_ns = last_stamp(waiting_.front());
    const auto pose_end_ns = pose_.trajectory().end_ns();
    const bool settled = pose_end_ns && *pose_end_ns >= end_ns;
    if (!settled && !all && to_seconds(now_ns_ - end_ns) < kLongestHold_s) break;
    const bool was_usable = lidar_usable();
    if (lidar_.add(waiting_.front(), pose_.trajectory()) && lidar_usable())
      packets.emplace_back(std::move(waiting_.front()));
    if (was_usable && !lidar_usable()) spoil_lidar();
    waiting_.pop_front();
  }
  passed.insert(passed.begin(), std::make_move_iterator(packets.begin()),
                std::make_move_iterator(packets.end()));
}

template <class Sample>
void HealthMonitor::receive_pose(Stream s, const Sample& sample, Passed& passed) {
  if (!believe(s, sample.t_ns)) return;
  if (pose_.add(sample)) {
    lidar_.forget_ground();
    spoil_lidar();
  }
  pose_.forget_before(now_ns_ - to_nanoseconds(kPoseKept_s));
  passed.emplace_back(sample);
}

void HealthMonitor::receive(const AttitudeSample& sample, Passed& passed) {
  receive_pose(Stream::kAttitude, sample, passed);
}

void HealthMonitor::receive(const PositionSample& sample, Passed& passed) {
  receive_pose(Stream::kPosition, sample, passed);
}

void HealthMonitor::receive(const HeightSample& sample, Passed& passed) {
  if (!believe(Stream::kHeight, sample.t_ns)) return;
  height_ = sample;
  passed.emplace_back(sample);
}

void HealthMonitor::spoil_lidar() { lidar_spoiled_ = true; }

bool HealthMonitor::take_lidar_spoiled() { return std::exchange(lidar_spoiled_, false); }

bool HealthMonitor::lidar_usable() const { return stream(Stream::kLidar).usable() && lidar_.usable(); }

bool HealthMonitor::stereo_usable() const {
  return stream(Stream::kCamera).usable() && left_.usable() && right_.usable() && alignment_.usable();
}

bool HealthMonitor::pose_usable() const {
  return stream(Stream::kAttitude).usable() && stream(Stream::kPosition).usable() && pose_.usable();
}

HealthState HealthMonitor::state(bool findings) const {
  if (!findings) return HealthState::kOk;
  const bool image_gives_depth = makers_ == DepthMakers::kImageAndLidar && stereo_usable();
  return pose_usable() && (lidar_usable() || image_gives_depth) ? HealthState::kDegraded
                                                                : HealthState::kFailed;
}

HealthReport HealthMonitor::report() const {
  HealthReport report;
  for (const StreamWatch& watch : streams_) watch.report(report.findings);
  // What was last seen of a sensor that is lost says nothing about it.
  if (stream(Stream::kCamera).usable()) {
    left_.report(report.findings);
    right_.report(report.findings);
    alignment_.report(report.findings);
  }
  if (stream(Stream::kLidar).usable()) lidar_.report(report.findings);
  pose_.report(report.findings);
  report.state = state(!report.findings.empty());
  return report;
}

HealthReport HealthMonitor::report(std::int64_t now_ns) const {
  if (!begin_ns_) return {};
  HealthMonitor later = *this;
  later.pass_time(now_ns);
  return later.report();
}

}  // namespace alight
