#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Geometry>

namespace alight {

/// The IMU's pose over time from two streams of their own rate, attitude and position (paper 3.1, step 1):
/// linear interpolation of position, spherical linear of attitude, between the two samples that bracket the
/// time. Never extrapolates, never bridges a gap.
class Trajectory {
 public:
  explicit Trajectory(double max_pose_gap_s);

  /// Samples must come in time order. @returns false (sample dropped) if not later than the last one or not
  /// finite
  bool add_attitude(std::int64_t t_ns, const Eigen::Quaterniond& q_world_imu);
  bool add_position(std::int64_t t_ns, const Eigen::Vector3d& p_world);

  /// Empty outside the samples and inside gaps longer than max_pose_gap_s.
  std::optional<Eigen::Isometry3d> T_world_imu(std::int64_t t_ns) const;

  /// Gives the same poses as T_world_imu, bit for bit; fast where many times lie between the same samples. The trajectory
  /// must not change meanwhile.
  class Cursor;

  /// The latest time with a pose, provided no gap follows; empty while a stream has no sample.
  std::optional<std::int64_t> end_ns() const;
  std::optional<std::int64_t> begin_ns() const;

  /// Drops what is not needed for times >= t_ns, so that an endless flight needs bounded memory.
  void forget_before(std::int64_t t_ns);

 private:
  template <class Value>
  struct Timed {
    std::int64_t t_ns;
    Value value;
  };
  template <class Value>
  using Stream = std::deque<Timed<Value>>;

  template <class Value>
  struct Bracket {
    const Timed<Value>* before;
    const Timed<Value>* after;
    double share(std::int64_t t_ns) const;  // 0 at before, 1 at after
  };
  template <class Value>
  std::optional<Bracket<Value>> bracket(const Stream<Value>& stream, std::int64_t t_ns) const;

  std::int64_t max_gap_ns_;
  Stream<Eigen::Quaterniond> attitudes_;
  Stream<Eigen::Vector3d> positions_;
};

/// Looks poses up in order of time, from where the last one was found. The trajectory must outlive it.
class Trajectory::Cursor {
 public:
  explicit Cursor(const Trajectory& trajectory) : trajectory_(trajectory) {}
  std::optional<Eigen::Isometry3d> T_world_imu(std::int64_t t_ns);

 private:
  bool move_to(std::int64_t t_ns);

  const Trajectory& trajectory_;
  std::optional<Bracket<Eigen::Quaterniond>> attitude_;
  std::optional<Bracket<Eigen::Vector3d>> position_;
  double angle_rad_ = 0;  // between the bracket's attitudes, on the unit sphere of quaternions
  double sine_ = 0;       // of it; 0 where the two are alike
  double sign_ = 1;       // of the second attitude, so that the short way is gone
};

}  // namespace alight
