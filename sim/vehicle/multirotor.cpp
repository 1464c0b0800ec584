#include "sim/vehicle/multirotor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

Eigen::Vector3d limited(const Eigen::Vector3d& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Eigen::Vector3d(v * (limit / norm)) : v;
}

Eigen::Vector3d drawn_wind(const CounterRandom& random, double wind_mps) {
  const double speed_mps = random.uniform(0, 0, wind_mps);
  const double from_rad = random.uniform(1, 0, kTwoPi);
  return {speed_mps * std::cos(from_rad), speed_mps * std::sin(from_rad), 0};
}

}  // namespace

void bind(Binder& b, MultirotorConfig& c) {
  b.field("max_speed_mps", c.max_speed_mps, "horizontal", between(0.1, 50));
  b.field("max_climb_mps", c.max_climb_mps, "upwards", between(0.1, 20));
  b.field("max_descent_mps", c.max_descent_mps, "downwards", between(0.1, 20));
  b.field("max_yaw_rate_deg_per_s", c.max_yaw_rate_deg_per_s, "either way", between(0, 720));
  b.field("max_acceleration_mps2", c.max_acceleration_mps2, "of the vehicle's own doing", between(0.1, 30));
  b.field("max_jerk_mps3", c.max_jerk_mps3, "how fast that may change", between(0.1, 1000));
  b.field("velocity_lag_s", c.velocity_lag_s, "of the velocity behind its set point", between(0.05, 10));
  b.field("yaw_lag_s", c.yaw_lag_s, "of the yaw rate behind its set point", between(0.01, 10));
  b.field("drag_per_s", c.drag_per_s, "acceleration by the air per unit of air speed", between(0, 2));
  b.field("wind_mps", c.wind_mps, "mean wind is drawn from 0 to this", between(0, 30));
  b.field("gust_mps", c.gust_mps, "1 sigma an axis of gusts", between(0, 20));
  b.field("gust_time_s", c.gust_time_s, "their correlation time", between(0.05, 100));
  b.field("trim_lag_s", c.trim_lag_s, "lag with which the autopilot leans into the wind", between(0.05, 100));
}

Multirotor::Multirotor(const MultirotorConfig& config, const Eigen::Vector3d& p_world, double yaw_rad,
                       std::uint64_t seed, double duration_s)
    : config_(config),
      duration_s_(duration_s),
      random_(seed, RandomStream::kWind),
      mean_wind_mps_(drawn_wind(random_, config.wind_mps)) {
  // It has hovered here for a while: leaning into the mean wind, in balance.
  trim_mps2_ = config_.drag_per_s * mean_wind_mps_;
  nodes_.push_back({p_world, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), -trim_mps2_, yaw_rad});
}

Eigen::Vector3d Multirotor::wanted_velocity() const {
  Eigen::Vector3d wanted = set_point_.velocity_mps;
  const double horizontal = wanted.head<2>().norm();
  if (horizontal > config_.max_speed_mps) wanted.head<2>() *= config_.max_speed_mps / horizontal;
  wanted.z() = std::clamp(wanted.z(), -config_.max_descent_mps, config_.max_climb_mps);
  return wanted;
}

void Multirotor::step() {
  const Node& now = nodes_.back();
  Node next = now;
  if (stopped_) {
    next.velocity_mps.setZero();
    next.acceleration_mps2.setZero();
    next.thrust_mps2.setZero();
    nodes_.push_back(next);
    return;
  }
  // Gusts: an Ornstein-Uhlenbeck process sampled exactly.
  const double keep = std::exp(-kStep_s / config_.gust_time_s);
  constexpr std::uint64_t kFirstGust = 16;
  gust_mps_ = keep * gust_mps_ +
              config_.gust_mps * std::sqrt(1 - keep * keep) * random_.normal3(kFirstGust + nodes_.size());
  const Eigen::Vector3d push_mps2 = config_.drag_per_s * (mean_wind_mps_ + gust_mps_ - now.velocity_mps);
  trim_mps2_ += (push_mps2 - trim_mps2_) * (kStep_s / config_.trim_lag_s);

  const Eigen::Vector3d wanted_mps2 =
      limited((wanted_velocity() - now.velocity_mps) / config_.velocity_lag_s, config_.max_acceleration_mps2);
  const Eigen::Vector3d change = (wanted_mps2 - trim_mps2_ - now.thrust_mps2) / kStep_s;
  next.thrust_mps2 = now.thrust_mps2 + kStep_s * limited(change, config_.max_jerk_mps3);
  next.acceleration_mps2 = next.thrust_mps2 + push_mps2;
  next.velocity_mps = now.velocity_mps + kStep_s * next.acceleration_mps2;
  next.p_world = now.p_world + 0.5 * kStep_s * (now.velocity_mps + next.velocity_mps);

  const double limit_radps = to_radians(config_.max_yaw_rate_deg_per_s);
  const double wanted_radps = std::clamp(set_point_.yaw_rate_radps, -limit_radps, limit_radps);
  yaw_rate_radps_ += (wanted_radps - yaw_rate_radps_) * std::min(1.0, kStep_s / config_.yaw_lag_s);
  next.yaw_rad = now.yaw_rad + kStep_s * yaw_rate_radps_;
  nodes_.push_back(next);
}

void Multirotor::advance_to(double t_s) {
  while (now_s() <= t_s) step();
}

/// Position by the cubic that has the velocities of both ends, the rest linear.
Multirotor::Node Multirotor::at(double t_s) const {
  const double place = std::max(0.0, t_s) / kStep_s;
  const auto i = static_cast<std::size_t>(place);
  if (i + 1 >= nodes_.size()) {
    if (i + 1 == nodes_.size() && place - static_cast<double>(i) < 1e-6) return nodes_[i];
    throw std::logic_error("Multirotor: asked for a time that was not flown yet");
  }
  const Node& a = nodes_[i];
  const Node& b = nodes_[i + 1];
  const double x = place - static_cast<double>(i);
  const double y = 1 - x;
  Node node;
  node.p_world = (1 + 2 * x) * y * y * a.p_world + x * x * (3 - 2 * x) * b.p_world +
                 kStep_s * x * y * (y * a.velocity_mps - x * b.velocity_mps);
  node.velocity_mps = y * a.velocity_mps + x * b.velocity_mps;
  node.acceleration_mps2 = y * a.acceleration_mps2 + x * b.acceleration_mps2;
  node.thrust_mps2 = y * a.thrust_mps2 + x * b.thrust_mps2;
  node.yaw_rad = y * a.yaw_rad + x * b.yaw_rad;
  return node;
}

Eigen::Isometry3d Multirotor::T_world_imu(double t_s) const {
  const Node node = at(t_s);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = attitude_of_thrust(node.thrust_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ(), node.yaw_rad);
  T.translation() = node.p_world;
  return T;
}

VehicleState Multirotor::state(double t_s) const {
  const Node node = at(t_s);
  VehicleState state;
  state.T_world_imu = T_world_imu(t_s);
  state.velocity_mps = node.velocity_mps;
  state.acceleration_mps2 = node.acceleration_mps2;
  const double before_s = std::max(0.0, t_s - kStep_s);
  if (t_s > before_s) {
    state.angular_velocity_imu_radps =
        angular_velocity_radps(T_world_imu(before_s).linear(), state.T_world_imu.linear(), t_s - before_s);
  }
  state.specific_force_imu_mps2 = state.T_world_imu.linear().transpose() *
                                  (node.acceleration_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ());
  return state;
}

}  // namespace alight::sim
