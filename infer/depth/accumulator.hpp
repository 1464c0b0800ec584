#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/projection.hpp"
#include "geometry/trajectory.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

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

/// Paper 3.1 step 2, split at the world frame. `previous_end_ns` (of the packet before) gives the duration of packets
/// whose points carry no times of their own.
WorldPacket to_world(const LidarPacket& packet, const Trajectory& trajectory,
                     const Eigen::Isometry3d& T_imu_lidar, std::optional<std::int64_t> previous_end_ns);

/// The LiDAR's recent past, in bounded memory: packets older than what any image may still ask for are forgotten,
/// and never more than `max_points` are held.
class Accumulator {
 public:
  explicit Accumulator(std::size_t max_points);

  void add(WorldPacketPtr packet);
  void forget_before(std::int64_t t_ns);

  /// Packets that ended by `t_ns`, newest first, reaching back `duration_s` of LiDAR time but no farther than
  /// `max_age_s`, and one more if there is one: it is held out, to judge a prediction from all the others.
  std::vector<WorldPacketPtr> before(std::int64_t t_ns, double duration_s, double max_age_s) const;
  /// Packets that ended later, oldest first.
  std::vector<WorldPacketPtr> after(std::int64_t t_ns) const;

  std::size_t points() const { return points_; }
  std::size_t packets() const { return packets_.size(); }

 private:
  void pop_oldest();

  std::size_t max_points_;
  std::size_t points_ = 0;
  std::deque<WorldPacketPtr> packets_;  // by end time
};

}  // namespace alight
