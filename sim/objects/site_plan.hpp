#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/random.hpp"

namespace alight::sim {

/// A rectangle on the ground, metres.
struct GroundRect {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double half_u_m = 0;
  double half_v_m = 0;
  Eigen::Vector2d u_axis = Eigen::Vector2d::UnitX();

  Eigen::Vector2d v_axis() const { return {-u_axis.y(), u_axis.x()}; }
  double yaw_rad() const;  ///< of the u axis, counter-clockwise from east
  Eigen::Vector2d at(double u_m, double v_m) const { return centre + u_axis * u_m + v_axis() * v_m; }
  /// 0 inside.
  double distance_m(const Eigen::Vector2d& p) const;
};

/// Unit vector at an angle counter-clockwise from east.
Eigen::Vector2d heading(double yaw_rad);

/// A straight piece of road from a to b.
struct GroundSegment {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();

  Eigen::Vector2d direction() const { return (b - a).normalized(); }
  Eigen::Vector2d nearest(const Eigen::Vector2d& p) const;
};

/// Which ground is taken, on a half-metre raster over a square around the origin; outside is taken.
class SitePlan {
 public:
  explicit SitePlan(double size_m);

  void occupy_disc(const Eigen::Vector2d& centre, double radius_m);
  void occupy_rect(const GroundRect& rect, double margin_m);
  void occupy_segment(const GroundSegment& segment, double half_width_m);

  bool is_free(const Eigen::Vector2d& centre, double radius_m) const;
  bool is_free(const GroundRect& rect, double margin_m) const;

  /// A place with `radius_m` of free ground around it, |x|, |y| <= half_width_m; empty after `attempts`
  /// misses.
  std::optional<Eigen::Vector2d> find_free(Random& random, double radius_m, double half_width_m,
                                           int attempts) const;

 private:
  template <class Inside>
  void occupy(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Inside& inside);
  template <class Inside>
  bool any_taken(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Inside& inside) const;
  int cell(double coordinate_m) const;
  Eigen::Vector2d centre_of(int row, int column) const;

  double half_m_;
  int cells_;
  std::vector<std::uint8_t> taken_;
};

}  // namespace alight::sim
