#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/objects/ground_figures.hpp"
#include "sim/random.hpp"

namespace alight::sim {

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
