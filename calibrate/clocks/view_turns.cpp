#include "calibrate/clocks/view_turns.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "calibrate/clocks/patch_search.hpp"
#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kMinPoints = 10;
constexpr std::int64_t kPoseStep_ns = kNanosecondsPerSecond / 100;

/// Mean poses over a window; samples without a pose leave a gap.
Trajectory smoothed(const Trajectory& trajectory, double smooth_s) {
  Trajectory result(0.25);
  const auto begin_ns = trajectory.begin_ns();
  const auto end_ns = trajectory.end_ns();
  if (!begin_ns || !end_ns) return result;
  const std::int64_t reach = to_nanoseconds(smooth_s) / kPoseStep_ns;
  for (std::int64_t t_ns = *begin_ns; t_ns <= *end_ns; t_ns += kPoseStep_ns) {
    const auto middle = trajectory.T_world_imu(t_ns);
    if (!middle) continue;
    const Eigen::Quaterniond q_middle(middle->linear());
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    Vector3d p = Vector3d::Zero();
    double count = 0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
      // Both sides or neither, so that the mean belongs to the middle.
      const auto before = trajectory.T_world_imu(t_ns - k * kPoseStep_ns);
      const auto after = trajectory.T_world_imu(t_ns + k * kPoseStep_ns);
      if (!before || !after) continue;
      const Eigen::Quaterniond turn(after->linear());
      q += (turn.dot(q_middle) < 0 ? -1.0 : 1.0) * turn.coeffs();
      p += after->translation();
      ++count;
    }
    result.add_attitude(t_ns, Eigen::Quaterniond(q.normalized()));
    result.add_position(t_ns, p / count);
  }
  return result;
}

std::optional<Isometry3d> camera_motion(const Trajectory& trajectory, const Isometry3d& T_camera_imu,
                                        const ViewPair& pair, std::int64_t offset_ns) {
  const auto begin = trajectory.T_world_imu(pair.begin_ns + offset_ns);
  const auto end = trajectory.T_world_imu(pair.end_ns + offset_ns);
  if (!begin || !end) return std::nullopt;
  return T_camera_imu * end->inverse() * *begin * T_camera_imu.inverse();
}

Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

}  // namespace

std::vector<ViewPair> follow_views(const FlightViews& flight, double points_window_s, std::int64_t offset_ns,
                                   std::size_t max_points) {
  std::vector<ViewPair> pairs;
  for (std::size_t i = 0; i + 1 < flight.views.size(); ++i) {
    const ExposureView& from = flight.views[i];
    const ExposureView& to = flight.views[i + 1];
    ViewPair pair{from.t_ns, to.t_ns, {}};
    const auto motion = camera_motion(flight.trajectory, flight.rig.T_camera_imu, pair, offset_ns);
    if (!motion) continue;
    const std::vector<SeenPoint> seen = seen_from(flight, from, flight.points, points_window_s);
    const std::size_t step = seen.size() / max_points + 1;
    for (std::size_t k = 0; k < seen.size(); k += step) {
      const Vector3d p = seen[k].T_view_own * seen[k].p_own;
      const Vector3d p_next = *motion * p;
      if (p.z() <= 0 || p_next.z() <= 0) continue;
      const Vector2d expected = flight.rig.intrinsics.project(p_next);
      const auto match = find_patch(from.left, flight.rig.intrinsics.project(p), to.left, expected);
      if (match) pair.points.push_back({p, expected + match->offset});
    }
    if (pair.points.size() >= kMinPoints) pairs.push_back(std::move(pair));
  }
  return pairs;
}

TurnResiduals::TurnResiduals(const FlightViews& flight, const std::vector<ViewPair>& pairs,
                             std::int64_t followed_ns, double smooth_s, double max_offset_s)
    : intrinsics_(flight.rig.intrinsics),
      T_camera_imu_(flight.rig.T_camera_imu),
      trajectory_(smoothed(flight.trajectory, smooth_s)) {
  constexpr std::int64_t kStep_ns = kNanosecondsPerSecond / 100;
  std::vector<std::int64_t> offsets_ns;
  const std::int64_t reach_ns =
      to_nanoseconds(max_offset_s) + 2 * kStep_ns;  // a climb may look a little beyond
  for (std::int64_t offset_ns = -reach_ns; offset_ns <= reach_ns; offset_ns += kStep_ns)
    offsets_ns.push_back(offset_ns);
  for (const ViewPair& pair : pairs) {
    if (std::all_of(offsets_ns.begin(), offsets_ns.end(),
                    [&](std::int64_t offset_ns) {
                      return camera_motion(trajectory_, T_camera_imu_, pair, offset_ns).has_value();
                    }) &&
        explained(pair, followed_ns))
      pairs_.push_back(pair);
  }
  if (pairs_.empty()) return;
  // What pairs leave over at their common best: the scale on which one is an outlier.
  double best_rad = 1;
  for (const std::int64_t offset_ns : offsets_ns) {
    std::vector<double> lengths;
    for (const ViewPair& pair : pairs_) lengths.push_back(left_over(pair, offset_ns).turn_rad.norm());
    best_rad = std::min(best_rad, median(lengths));
  }
  scale_rad_ = std::max(2 * best_rad, 1e-5);
}

TurnResiduals::Left TurnResiduals::left_over(const ViewPair& pair, std::int64_t offset_ns) const {
  constexpr double kOutlier_px = 1.5;
  constexpr int kRounds = 4;
  Left left;
  const auto motion = camera_motion(trajectory_, T_camera_imu_, pair, offset_ns);
  if (!motion) return left;
  left.posed_rad = rotation_vector(motion->linear());
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-3;
    Vector3d g = Vector3d::Zero();
    const double width_px = kOutlier_px * std::pow(2.0, kRounds - 1 - round);
    for (const FollowedPoint& point : pair.points) {
      const Vector3d p = *motion * point.p_camera;
      const Eigen::Matrix<double, 2, 3> J = pixel_by_turn(p / p.z(), intrinsics_);
      const Vector2d offset = point.found - intrinsics_.project(p);
      const Vector2d r = offset - J * left.turn_rad;
      const double weight = std::pow(1 + r.squaredNorm() / (width_px * width_px), -2);
      H += weight * J.transpose() * J;
      g += weight * J.transpose() * r;
    }
    left.turn_rad += H.ldlt().solve(g);
  }
  return left;
}

bool TurnResiduals::explained(const ViewPair& pair, std::int64_t offset_ns) const {
  constexpr double kExplained_px = 1.5;
  constexpr double kMinShare = 0.5;
  const auto motion = camera_motion(trajectory_, T_camera_imu_, pair, offset_ns);
  if (!motion) return false;
  const Vector3d turn_rad = left_over(pair, offset_ns).turn_rad;
  const auto count = std::count_if(pair.points.begin(), pair.points.end(), [&](const FollowedPoint& point) {
    const Vector3d p = *motion * point.p_camera;
    const Vector2d expected = intrinsics_.project(p) + pixel_by_turn(p / p.z(), intrinsics_) * turn_rad;
    return (point.found - expected).norm() < kExplained_px;
  });
  return static_cast<double>(count) >= kMinShare * static_cast<double>(pair.points.size());
}

std::vector<double> TurnResiduals::scores(std::int64_t offset_ns) const {
  std::vector<double> result;
  for (const ViewPair& pair : pairs_) {
    const Left left = left_over(pair, offset_ns);
    result.push_back(-std::log1p(left.turn_rad.squaredNorm() / (scale_rad_ * scale_rad_)));
  }
  return result;
}

std::vector<ViewTurn> TurnResiduals::turns(std::int64_t offset_ns) const {
  std::vector<ViewTurn> result;
  for (const ViewPair& pair : pairs_) {
    const Left left = left_over(pair, offset_ns);
    const std::int64_t middle_ns = pair.begin_ns + (pair.end_ns - pair.begin_ns) / 2;
    result.push_back(
        {to_seconds(middle_ns - pairs_.front().begin_ns), left.posed_rad + left.turn_rad, left.posed_rad});
  }
  return result;
}

}  // namespace alight
