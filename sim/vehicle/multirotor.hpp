#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "foundation/binder_fwd.hpp"
#include "sim/counter_random.hpp"
#include "sim/vehicle/motion.hpp"

namespace alight::sim {

/// A multirotor that follows velocity set points, and the wind that it flies in.
struct MultirotorConfig {
  double max_speed_mps = 8;  ///< horizontal
  double max_climb_mps = 4;
  double max_descent_mps = 3;
  double max_yaw_rate_deg_per_s = 60;
  double max_acceleration_mps2 = 3;
  double max_jerk_mps3 = 12;
  double velocity_lag_s = 0.5;  ///< first-order lag of the velocity behind its set point
  double yaw_lag_s = 0.3;
  double drag_per_s = 0.15;  ///< acceleration by the air per unit of air speed
  double wind_mps = 3;       ///< mean wind is drawn from 0 to this, its direction from all around
  double gust_mps = 1;       ///< 1 sigma an axis of gusts on top
  double gust_time_s = 2;    ///< their correlation time
  double trim_lag_s = 1.5;   ///< the autopilot leans into the wind with this lag
};
void bind(Binder& b, MultirotorConfig& c);

/// What an autopilot is asked to fly.
struct VelocitySetPoint {
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< world
  double yaw_rate_radps = 0;
};

/// A kinematic multirotor, integrated in steps of kStep_s. The velocity follows the set point with a first-order lag,
/// within the limits; roll and pitch follow from the thrust that this takes, wind included; yaw is free. Where it has
/// flown stays known at any time, since sensors look back. Depends on configuration, seed and set points alone.
class Multirotor : public Motion {
 public:
  static constexpr double kStep_s = 0.005;

  /// @param duration_s the longest that the flight can last; space for it is not taken in advance
  Multirotor(const MultirotorConfig& config, const Eigen::Vector3d& p_world, double yaw_rad,
             std::uint64_t seed, double duration_s);

  /// Holds from the present on.
  void command(const VelocitySetPoint& set_point) { set_point_ = set_point; }
  /// Flies on until `t_s` is in the past.
  void advance_to(double t_s);
  /// Stands still from the present on: it has landed or hit something.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }
  /// How far the flight is known.
  double now_s() const { return static_cast<double>(nodes_.size() - 1) * kStep_s; }
  const Eigen::Vector3d& p_world() const { return nodes_.back().p_world; }
  const Eigen::Vector3d& velocity_mps() const { return nodes_.back().velocity_mps; }
  /// Mean wind, without gusts.
  const Eigen::Vector3d& mean_wind_mps() const { return mean_wind_mps_; }

  /// @throws std::logic_error for a time that was not flown yet
  Eigen::Isometry3d T_world_imu(double t_s) const override;
  VehicleState state(double t_s) const override;
  double duration_s() const override { return duration_s_; }

 private:
  struct Node {
    Eigen::Vector3d p_world;
    Eigen::Vector3d velocity_mps;
    Eigen::Vector3d acceleration_mps2;
    Eigen::Vector3d thrust_mps2;  // without the part that carries the weight
    double yaw_rad;
  };
  void step();
  Eigen::Vector3d wanted_velocity() const;
  Node at(double t_s) const;

  MultirotorConfig config_;
  double duration_s_;
  CounterRandom random_;
  Eigen::Vector3d mean_wind_mps_;
  Eigen::Vector3d gust_mps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d trim_mps2_ = Eigen::Vector3d::Zero();  // the air's push, as the autopilot knows it
  double yaw_rate_radps_ = 0;
  VelocitySetPoint set_point_;
  bool stopped_ = false;
  std::vector<Node> nodes_;
};

}  // namespace alight::sim
