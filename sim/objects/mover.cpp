#include "sim/objects/mover.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace alight::sim {

Mover::Mover(std::size_t mesh, const Eigen::Vector3f& tint_rgb, const Eigen::Vector2d& from,
             const Eigen::Vector2d& to, std::vector<double> heights_m)
    : mesh_(mesh),
      tint_rgb_(tint_rgb),
      from_(from),
      way_m_(to - from),
      length_m_(way_m_.norm()),
      heights_m_(std::move(heights_m)) {
  if (heights_m_.size() < 2 || !(length_m_ > 0))
    throw std::invalid_argument("Mover: a way needs a length and two heights");
  const auto yaw = static_cast<float>(std::atan2(way_m_.y(), way_m_.x()));
  R_world_mesh_ = Eigen::AngleAxisf(yaw, Eigen::Vector3f::UnitZ()).toRotationMatrix();
}

void Mover::set_pace(double begin_s, double speed_mps, AtWaysEnd end) {
  begin_s_ = begin_s;
  speed_mps_ = speed_mps;
  end_ = end;
}

Eigen::Vector3f Mover::p_world(double t_s) const {
  double share = std::max(0.0, (t_s - begin_s_) * speed_mps_ / length_m_);
  if (end_ == AtWaysEnd::kAnew) share -= std::floor(share);
  if (end_ == AtWaysEnd::kBack) share = 1 - std::abs(std::fmod(share, 2.0) - 1);
  share = std::min(share, 1.0);
  const double at = share * static_cast<double>(heights_m_.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(at), heights_m_.size() - 2);
  const double part = at - static_cast<double>(before);
  const Eigen::Vector2d p = from_ + share * way_m_;
  return Eigen::Vector3d(p.x(), p.y(), (1 - part) * heights_m_[before] + part * heights_m_[before + 1])
      .cast<float>();
}

}  // namespace alight::sim
