#include "geometry/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/frames.hpp"

namespace alight {

Trajectory::Trajectory(double max_pose_gap_s) : max_gap_ns_(to_nanoseconds(max_pose_gap_s)) {}

bool Trajectory::add_attitude(std::int64_t t_ns, const Eigen::Quaterniond& q_world_imu) {
  const double norm = q_world_imu.norm();
  if (!(norm > 0.5 && norm < 2.0)) return false;  // NaN and the zero quaternion of a driver without a fix
  if (!attitudes_.empty() && t_ns <= attitudes_.back().t_ns) return false;
  attitudes_.push_back({t_ns, q_world_imu.normalized()});
  return true;
}

bool Trajectory::add_position(std::int64_t t_ns, const Eigen::Vector3d& p_world) {
  if (!p_world.allFinite() || (!positions_.empty() && t_ns <= positions_.back().t_ns)) return false;
  positions_.push_back({t_ns, p_world});
  return true;
}

template <class Value>
double Trajectory::Bracket<Value>::share(std::int64_t t_ns) const {
  if (after == before) return 0.0;
  return static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
}

template <class Value>
std::optional<Trajectory::Bracket<Value>> Trajectory::bracket(const Stream<Value>& stream,
                                                              std::int64_t t_ns) const {
  const auto after =
      std::lower_bound(stream.begin(), stream.end(), t_ns,
                       [](const Timed<Value>& sample, std::int64_t t) { return sample.t_ns < t; });
  if (after == stream.end()) return std::nullopt;
  if (after->t_ns == t_ns) return Bracket<Value>{&*after, &*after};
  if (after == stream.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->t_ns - before->t_ns > max_gap_ns_) return std::nullopt;
  return Bracket<Value>{&*before, &*after};
}

std::optional<Eigen::Isometry3d> Trajectory::T_world_imu(std::int64_t t_ns) const {
  return Cursor(*this).T_world_imu(t_ns);
}

bool Trajectory::Cursor::move_to(std::int64_t t_ns) {
  const auto holds = [t_ns](const auto& bracket) {
    return bracket && bracket->before->t_ns < t_ns && t_ns < bracket->after->t_ns;
  };
  if (!holds(position_)) position_ = trajectory_.bracket(trajectory_.positions_, t_ns);
  if (!position_) return false;
  if (holds(attitude_)) return true;
  attitude_ = trajectory_.bracket(trajectory_.attitudes_, t_ns);
  if (!attitude_) return false;
  const double dot = attitude_->before->value.dot(attitude_->after->value);
  const bool alike = std::abs(dot) >= 1 - std::numeric_limits<double>::epsilon();
  angle_rad_ = alike ? 0 : std::acos(std::abs(dot));
  sine_ = alike ? 0 : std::sin(angle_rad_);
  sign_ = dot < 0 ? -1 : 1;
  return true;
}

std::optional<Eigen::Isometry3d> Trajectory::Cursor::T_world_imu(std::int64_t t_ns) {
  if (!move_to(t_ns)) return std::nullopt;
  const double along = attitude_->share(t_ns);
  const double weight_before = sine_ == 0 ? 1 - along : std::sin((1 - along) * angle_rad_) / sine_;
  const double weight_after = sign_ * (sine_ == 0 ? along : std::sin(along * angle_rad_) / sine_);
  const Eigen::Quaterniond q_world_imu(weight_before * attitude_->before->value.coeffs() +
                                       weight_after * attitude_->after->value.coeffs());
  const Eigen::Vector3d& before = position_->before->value;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q_world_imu.toRotationMatrix();
  T.translation() = before + position_->share(t_ns) * (position_->after->value - before);
  return T;
}

std::optional<std::int64_t> Trajectory::begin_ns() const {
  if (attitudes_.empty() || positions_.empty()) return std::nullopt;
  return std::max(attitudes_.front().t_ns, positions_.front().t_ns);
}

std::optional<std::int64_t> Trajectory::end_ns() const {
  if (attitudes_.empty() || positions_.empty()) return std::nullopt;
  return std::min(attitudes_.back().t_ns, positions_.back().t_ns);
}

void Trajectory::forget_before(std::int64_t t_ns) {
  const auto trim = [t_ns](auto& stream) {
    while (stream.size() > 1 && stream[1].t_ns <= t_ns) stream.pop_front();
  };
  trim(attitudes_);
  trim(positions_);
}

}  // namespace alight
