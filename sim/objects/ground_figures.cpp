#include "sim/objects/ground_figures.hpp"

#include <algorithm>
#include <cmath>

namespace alight::sim {

Eigen::Vector2d heading(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }

double GroundRect::yaw_rad() const { return std::atan2(u_axis.y(), u_axis.x()); }

double GroundRect::distance_m(const Eigen::Vector2d& p) const {
  const double u = std::max(std::abs((p - centre).dot(u_axis)) - half_u_m, 0.0);
  const double v = std::max(std::abs((p - centre).dot(v_axis())) - half_v_m, 0.0);
  return std::hypot(u, v);
}

Eigen::Vector2d GroundSegment::nearest(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d along = b - a;
  return a + along * std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

}  // namespace alight::sim
