#include "geometry/trajectory.hpp"

#include <algorithm>

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
std::optional<Trajectory::Bracket<Value>> Trajectory::bracket(const Stream<Value>& stream,
                                                              std::int64_t t_ns) const {
  const auto after =
      std::lower_bound(stream.begin(), stream.end(), t_ns,
                       [](const Timed<Value>& sample, std::int64_t t) { return sample.t_ns < t; });
  if (after == stream.end()) return std::nullopt;
  if (after->t_ns == t_ns) return Bracket<Value>{&after->value, &after->value, 0.0};
  if (after == stream.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->t_ns - before->t_ns;
  if (gap_ns > max_gap_ns_) return std::nullopt;
  return Bracket<Value>{&before->value, &after->value,
                        static_cast<double>(t_ns - before->t_ns) / static_cast<double>(gap_ns)};
}

std::optional<Eigen::Isometry3d> Trajectory::T_world_imu(std::int64_t t_ns) const {
  const auto attitude = bracket(attitudes_, t_ns);
  const auto position = bracket(positions_, t_ns);
  if (!attitude || !position) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = attitude->before->slerp(attitude->share, *attitude->after).toRotationMatrix();
  T.translation() = *position->before + position->share * (*position->after - *position->before);
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
