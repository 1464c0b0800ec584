#include "sensors/poses/alignment.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "geometry/frames.hpp"

namespace alight {

bool FlightTrajectory::add(const PositionSample& sample) {
  return trajectory_.add_position(sample.t_ns, world_.to_world(sample));
}

void HeightTrack::add(const HeightSample& sample) {
  if (samples_.empty() || sample.t_ns > samples_.back().t_ns) samples_.push_back(sample);
}

double HeightTrack::at(std::int64_t t_ns) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t_ns,
                                      [](const HeightSample& s, std::int64_t t) { return s.t_ns < t; });
  if (after == samples_.end()) return kNone;
  if (after->t_ns == t_ns) return after->height_m;
  if (after == samples_.begin()) return kNone;
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->t_ns - before->t_ns;
  if (gap_ns > kNanosecondsPerSecond) return kNone;
  const double share = static_cast<double>(t_ns - before->t_ns) / static_cast<double>(gap_ns);
  return before->height_m + share * (after->height_m - before->height_m);
}

double HeightTrack::at_or_latest(std::int64_t t_ns, std::int64_t max_age_ns) const {
  const bool latest =
      !samples_.empty() && samples_.back().t_ns < t_ns && t_ns - samples_.back().t_ns <= max_age_ns;
  return latest ? samples_.back().height_m : at(t_ns);
}

void HeightTrack::forget_before(std::int64_t t_ns) {
  while (samples_.size() > 1 && samples_[1].t_ns <= t_ns) samples_.pop_front();
}

AlignedPoints align_points(const std::vector<LidarReturn>& returns, const Trajectory& trajectory,
                           const Eigen::Isometry3d& T_imu_lidar) {
  AlignedPoints aligned;
  aligned.points.reserve(returns.size());
  std::optional<std::int64_t> pose_ns;  // points of a driver without point times share one pose
  std::optional<Eigen::Isometry3d> T_world_lidar;
  Trajectory::Cursor cursor(trajectory);
  for (const LidarReturn& point : returns) {
    if (pose_ns != point.t_ns) {
      pose_ns = point.t_ns;
      T_world_lidar = cursor.T_world_imu(point.t_ns);
      if (T_world_lidar) T_world_lidar = *T_world_lidar * T_imu_lidar;
    }
    if (!T_world_lidar) {
      ++aligned.without_pose;
      continue;
    }
    aligned.points.push_back({point.t_ns, *T_world_lidar * point.p_lidar.cast<double>()});
  }
  return aligned;
}

void PointWindow::add(std::vector<WorldPoint> points) {
  if (points.empty()) return;
  const auto [first, last] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  const std::int64_t begin_ns = first->t_ns;
  const std::int64_t end_ns = last->t_ns;
  batches_.push_back({begin_ns, end_ns, std::move(points)});
}

void PointWindow::forget_before(std::int64_t t_ns) {
  while (!batches_.empty() && batches_.front().end_ns < t_ns) batches_.pop_front();
}

int PointWindow::project(std::int64_t begin_ns, std::int64_t end_ns, const Eigen::Isometry3d& T_camera_world,
                         const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns,
                         const DepthRange& range, SparseDepth& out) const {
  int inside = 0;
  for (const Batch& batch : batches_) {
    if (batch.end_ns < begin_ns || batch.begin_ns > end_ns) continue;
    if (batch.begin_ns >= begin_ns && batch.end_ns <= end_ns) {
      inside += project_points(batch.points, T_camera_world, intrinsics, t_image_ns, range, out);
      continue;
    }
    std::vector<WorldPoint> part;
    std::copy_if(batch.points.begin(), batch.points.end(), std::back_inserter(part),
                 [&](const WorldPoint& point) { return point.t_ns >= begin_ns && point.t_ns <= end_ns; });
    inside += project_points(part, T_camera_world, intrinsics, t_image_ns, range, out);
  }
  return inside;
}

}  // namespace alight
