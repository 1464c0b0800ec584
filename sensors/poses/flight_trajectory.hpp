#pragma once

#include <cstdint>
#include <deque>

#include "geometry/trajectory.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/poses/world_frame.hpp"

namespace alight {

/// The vehicle's pose from the messages of a flight (paper 3.1 step 1), in the `world` of WorldFrame.
class FlightTrajectory {
 public:
  explicit FlightTrajectory(double max_pose_gap_s) : trajectory_(max_pose_gap_s) {}

  /// @returns false if the sample was not later than the one before, and dropped
  bool add(const AttitudeSample& sample) { return trajectory_.add_attitude(sample.t_ns, sample.q_world_imu); }
  bool add(const PositionSample& sample);

  /// True once no later sample can change whether `t_ns` has a pose.
  bool settled(std::int64_t t_ns) const {
    const auto end_ns = trajectory_.end_ns();
    return end_ns && *end_ns >= t_ns;
  }

  const Trajectory& trajectory() const { return trajectory_; }
  void forget_before(std::int64_t t_ns) { trajectory_.forget_before(t_ns); }

 private:
  Trajectory trajectory_;
  WorldFrame world_;
};

/// The height above take-off over time, linear between samples.
class HeightTrack {
 public:
  void add(const HeightSample& sample);
  /// NaN outside the samples and in gaps longer than a second.
  double at(std::int64_t t_ns) const;
  /// The latest sample's height where that is no older than `max_age_ns`, else as at(): for whoever cannot wait for the
  /// sample that follows.
  double at_or_latest(std::int64_t t_ns, std::int64_t max_age_ns) const;
  void forget_before(std::int64_t t_ns);

 private:
  std::deque<HeightSample> samples_;
};

}  // namespace alight
