#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "sensors/messages/message_types.hpp"
#include "sensors/poses/alignment.hpp"
#include "sensors/poses/flight_trajectory.hpp"

namespace alight {

/// How long poses are waited for, in the time of the messages.
struct PoseWait {
  double max_pose_gap_s = 0.25;  ///< poses further apart are not interpolated between
  double max_wait_s = 2.0;       ///< how late a pose may come before what waits for it is given up
};

/// Paper 3.1, steps 1 and 2, for data sets and for flight alike: collects the vehicle's poses, lets LiDAR packets and images
/// wait for theirs, gives up what waits too long, and places every point in the world at its own time. Knows no clock
/// but the messages' times: the same messages in the same order give the same packets.
class PacketAligner {
 public:
  PacketAligner(const PoseWait& wait, const Eigen::Isometry3d& T_imu_lidar)
      : wait_(wait), T_imu_lidar_(T_imu_lidar), poses_(wait.max_pose_gap_s) {}

  void add(const AttitudeSample& sample);
  void add(const PositionSample& sample);
  void add(const HeightSample& sample);
  void add(LidarPacket packet);
  /// A message about this time came; of the kinds above it is known.
  void saw(std::int64_t t_ns);
  /// No message follows: nothing waits any more.
  void finish() { finished_ = true; }
  bool finished() const { return finished_; }

  /// The next packet, in order of arrival, whose poses came or were given up. One that waits for its pose holds back
  /// those behind it, which are later still. Its points may be none.
  std::optional<WorldPacket> next();
  /// Packets that wait are wrong, and not wanted any more.
  void forget_packets() { packets_.clear(); }

  /// The pose of an image; none while it has not come, and in gaps.
  std::optional<Eigen::Isometry3d> T_world_imu(std::int64_t t_ns) const {
    return poses_.trajectory().T_world_imu(t_ns);
  }
  /// True once no later message can change whether there is a pose at `t_ns`.
  bool settled(std::int64_t t_ns) const { return finished_ || poses_.settled(t_ns); }
  /// True once whatever should have come by `t_ns` is late by more than max_wait_s.
  bool late(std::int64_t t_ns) const;
  const HeightTrack& heights() const { return heights_; }

  /// The latest time of any message; none before the first.
  std::optional<std::int64_t> now_ns() const { return now_ns_; }
  /// LiDAR points up to here have left by next().
  std::optional<std::int64_t> placed_until_ns() const { return placed_until_ns_; }

  /// Poses and heights that nobody asks for any more.
  void forget_before(std::int64_t t_ns);
  /// What was left out: reason -> count. Whoever leaves out what depends on poses counts it here, too.
  const std::map<std::string, std::int64_t>& dropped() const { return dropped_; }
  void drop(const std::string& reason, std::int64_t count = 1) { dropped_[reason] += count; }

 private:
  PoseWait wait_;
  Eigen::Isometry3d T_imu_lidar_;
  FlightTrajectory poses_;
  HeightTrack heights_;
  std::deque<LidarPacket> packets_;  // waiting for a pose
  std::optional<std::int64_t> now_ns_;
  std::optional<std::int64_t> placed_until_ns_;
  std::optional<std::int64_t> previous_end_ns_;
  std::map<std::string, std::int64_t> dropped_;
  bool finished_ = false;
};

}  // namespace alight
