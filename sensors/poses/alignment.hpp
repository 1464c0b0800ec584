#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/projection.hpp"
#include "geometry/trajectory.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/poses/world_frame.hpp"

namespace alight {

/// Which pose a LiDAR point is placed with. `kImageTime`, the vehicle's pose when the image was taken, is
/// what the paper's alignment corrects; it is kept so that a test can show that the difference is seen.
enum class PointPose { kOwnTime, kImageTime };

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

/// The points of a sliding window in time; memory is bounded by what `forget_before` leaves.
class PointWindow {
 public:
  void add(std::vector<WorldPoint> points);
  void forget_before(std::int64_t t_ns);

  /// Projects the points of [begin_ns, end_ns] into an image. @returns points that fell into the image and
  /// range
  int project(std::int64_t begin_ns, std::int64_t end_ns, const Eigen::Isometry3d& T_camera_world,
              const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns, const DepthRange& range,
              SparseDepth& out) const;

 private:
  struct Batch {
    std::int64_t begin_ns;
    std::int64_t end_ns;
    std::vector<WorldPoint> points;
  };
  std::deque<Batch> batches_;
};

}  // namespace alight
