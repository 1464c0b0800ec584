#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace alight::sim {

/// A stretch of flight at one velocity and yaw rate. The change from the previous stretch's takes the first
/// `blend_s` of it.
struct FlightPhase {
  double duration_s = 0;
  double blend_s = 0;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< world
  double yaw_rate_radps = 0;
};

/// Where a path begins and how fast.
struct FlightStart {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  double yaw_rad = 0;  ///< from east, counter-clockwise
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  double yaw_rate_radps = 0;
};

/// What a path says about one moment.
struct PathPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  double yaw_rad = 0;
};

/// A smooth path in closed form. Velocities are blended by the quintic smoothstep, whose first and second
/// derivatives vanish at both ends: acceleration and jerk are continuous, and so are tilt and body rates.
class FlightPath {
 public:
  /// @throws std::invalid_argument if a phase has no duration or blends for longer than it lasts
  FlightPath(const FlightStart& start, const std::vector<FlightPhase>& phases);

  double duration_s() const { return duration_s_; }

  /// Any time: outside [0, duration] the first and the last velocity are kept.
  PathPoint at(double t_s) const;

  /// Adds the slow sway of a hovering multirotor: two sines an axis of 0.15 to 0.4 Hz, together `sway_m` (1
  /// sigma).
  void add_sway(double sway_m, std::uint64_t seed);

 private:
  struct Segment {
    double begin_s;
    FlightPhase phase;
    FlightStart from;  // state at begin_s
  };
  struct Sine {
    Eigen::Vector3d direction_m;
    double frequency_radps;
    double phase_rad;
  };
  static PathPoint evaluate(const Segment& segment, double t_s);

  std::vector<Segment> segments_;
  std::vector<Sine> sway_;
  double duration_s_ = 0;
};

}  // namespace alight::sim
