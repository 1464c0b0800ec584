#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "dataset/messages/message_types.hpp"
#include "geometry/geodesy.hpp"
#include "geometry/trajectory.hpp"

namespace alight {

/// The vehicle's poses in `world`, whose origin is the first position fix.
class PoseSource {
 public:
  explicit PoseSource(double max_pose_gap_s) : trajectory_(max_pose_gap_s) {}

  /// @returns false if the sample was dropped (not finite, not later than the last one)
  bool add(const AttitudeSample& sample) { return trajectory_.add_attitude(sample.t_ns, sample.q_world_imu); }
  bool add(const PositionSample& sample) {
    if (!enu_) enu_.emplace(sample.latitude_deg, sample.longitude_deg, sample.altitude_m);
    return trajectory_.add_position(
        sample.t_ns, enu_->to_world(sample.latitude_deg, sample.longitude_deg, sample.altitude_m));
  }

  /// True once no later sample can change whether `t_ns` has a pose.
  bool settled(std::int64_t t_ns) const {
    const auto end_ns = trajectory_.end_ns();
    return end_ns && *end_ns >= t_ns;
  }

  const Trajectory& trajectory() const { return trajectory_; }
  void forget_before(std::int64_t t_ns) { trajectory_.forget_before(t_ns); }

 private:
  Trajectory trajectory_;
  std::optional<LocalEnu> enu_;
};

}  // namespace alight
