#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/trajectory.hpp"
#include "infer/health/ground_memory.hpp"
#include "infer/health/symptom.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// Whether LiDAR packets hold what the surroundings send back: as many points as usual, new ones, few that hang alone
/// in the air, and the ground where it was a moment ago.
class LidarWatch {
 public:
  /// @param T_imu_lidar mounting
  LidarWatch(const HealthConfig& config, const Eigen::Isometry3d& T_imu_lidar);

  /// @param trajectory poses around the packet's time. @returns whether this very packet may be used
  bool add(const LidarPacket& packet, const Trajectory& trajectory);
  /// The vehicle's pose has leapt: what was measured before lies elsewhere now.
  void forget_ground() { ground_.clear(); }

  /// No confirmed fault but missing points, which leave the others right.
  bool usable() const;
  void report(std::vector<HealthFinding>& findings) const;
  /// Distance of the ground along the boresight: the middle of the last packet's echoes.
  std::optional<double> distance_m() const { return distance_m_; }

 private:
  void count_points(std::int64_t t_ns, const LidarPacket& packet);
  bool noisy(std::int64_t t_ns, const LidarPacket& packet);
  bool frozen(std::int64_t t_ns, const LidarPacket& packet);
  /// Notes which mirrors fit. @returns whether there is one
  bool mirror_fits(const LidarPacket& packet, const Trajectory& trajectory, double misfit_m);
  void watch_mirror(const LidarPacket& packet, const Trajectory& trajectory, const GroundFit& fit);
  bool contradicts_ground(std::int64_t t_ns, const LidarPacket& packet, const Trajectory& trajectory);
  /// Some of the packet's echoes in the world, with the LiDAR's y and z axes multiplied by `signs`.
  std::vector<Eigen::Vector3d> in_world(const LidarPacket& packet, const Trajectory& trajectory,
                                        const Eigen::Vector3d& signs) const;

  HealthConfig config_;
  Eigen::Isometry3d T_imu_lidar_;
  GroundMemory ground_;
  GroundMemory doubted_;  // of packets that contradict ground_: are they at one among themselves?
  std::deque<double> point_counts_;
  std::vector<LidarReturn> last_;
  std::optional<double> distance_m_;
  Symptom partial_;
  Symptom noise_;
  Symptom frozen_;
  Symptom mirrored_;
  std::array<bool, 3> mirrors_fitted_{};     // since the LiDAR is thought to be mirrored
  std::optional<std::int64_t> straight_ns_;  // since then packets that said anything were no mirror images
  Symptom strange_;
};

}  // namespace alight
