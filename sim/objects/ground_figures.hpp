#pragma once

#include <Eigen/Core>

namespace alight::sim {

/// Unit vector at an angle counter-clockwise from east.
Eigen::Vector2d heading(double yaw_rad);
/// The same vector, turned by a quarter counter-clockwise.
inline Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// A rectangle on the ground, metres.
struct GroundRect {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double half_u_m = 0;
  double half_v_m = 0;
  Eigen::Vector2d u_axis = Eigen::Vector2d::UnitX();

  Eigen::Vector2d v_axis() const { return left_of(u_axis); }
  double yaw_rad() const;  ///< of the u axis, counter-clockwise from east
  Eigen::Vector2d at(double u_m, double v_m) const { return centre + u_axis * u_m + v_axis() * v_m; }
  /// 0 inside.
  double distance_m(const Eigen::Vector2d& p) const;
};

/// A straight piece of road from a to b.
struct GroundSegment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();

  Eigen::Vector2d direction() const { return (b - a).normalized(); }
  Eigen::Vector2d nearest(const Eigen::Vector2d& p) const;
};

}  // namespace alight::sim
