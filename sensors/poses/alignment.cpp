#include "sensors/poses/alignment.hpp"

#include <algorithm>
#include <utility>

#include "geometry/frames.hpp"

namespace alight {
namespace {

/// A packet after a pause did not measure during the pause.
constexpr double kLongestPacket_s = 0.2;

}  // namespace

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

std::int64_t end_of(const LidarPacket& packet) {
  std::int64_t end_ns = packet.t_ns;
  if (!packet.returns.empty()) end_ns = packet.returns.front().t_ns;
  for (const LidarReturn& echo : packet.returns) end_ns = std::max(end_ns, echo.t_ns);
  return end_ns;
}

WorldPacket to_world(const LidarPacket& packet, const Trajectory& trajectory,
                     const Eigen::Isometry3d& T_imu_lidar, std::optional<std::int64_t> previous_end_ns) {
  WorldPacket world;
  world.end_ns = end_of(packet);
  world.begin_ns = world.end_ns;
  for (const LidarReturn& echo : packet.returns) world.begin_ns = std::min(world.begin_ns, echo.t_ns);
  AlignedPoints aligned = align_points(packet.returns, trajectory, T_imu_lidar);
  world.points = std::move(aligned.points);
  world.without_pose = aligned.without_pose;
  world.duration_s = to_seconds(world.end_ns - world.begin_ns);
  if (world.duration_s <= 0 && previous_end_ns)
    world.duration_s = to_seconds(world.end_ns - *previous_end_ns);
  world.duration_s = std::clamp(world.duration_s, 0.0, kLongestPacket_s);
  return world;
}

}  // namespace alight
