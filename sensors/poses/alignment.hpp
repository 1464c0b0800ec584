#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/projection.hpp"
#include "geometry/trajectory.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// LiDAR points placed in the world, each with the vehicle's pose at its own time.
struct AlignedPoints {
  std::vector<WorldPoint> points;
  std::int64_t without_pose = 0;  ///< points dropped: outside the trajectory or inside a gap
};

/// Paper 3.1 step 2, split at the world frame: p_world = T_world_imu(t1) * T_imu_lidar * p_lidar. What is
/// left, T_camera_imu * T_world_imu(t0)^-1, belongs to the image, so that a point is placed once for all
/// images that see it.
AlignedPoints align_points(const std::vector<LidarReturn>& returns, const Trajectory& trajectory,
                           const Eigen::Isometry3d& T_imu_lidar);

/// A LiDAR packet in the world, every point at its own time's pose. Made once, then shared by all images.
struct WorldPacket {
  std::int64_t begin_ns = 0;  ///< first point
  std::int64_t end_ns = 0;    ///< last point
  double duration_s = 0;      ///< LiDAR time that it adds to an accumulation
  double height_shift_m = 0;  ///< of its points, against other packets' (HeightRegistration)
  std::vector<WorldPoint> points;
  std::int64_t without_pose = 0;  ///< points left out because no pose brackets their time
};
using WorldPacketPtr = std::shared_ptr<const WorldPacket>;

/// Time of the last point; the stamp of a packet without points.
std::int64_t end_of(const LidarPacket& packet);

/// Paper 3.1 step 2 for a packet. `previous_end_ns` (of the packet before) gives the duration of packets whose points carry
/// no times of their own.
WorldPacket to_world(const LidarPacket& packet, const Trajectory& trajectory,
                     const Eigen::Isometry3d& T_imu_lidar, std::optional<std::int64_t> previous_end_ns);

}  // namespace alight
