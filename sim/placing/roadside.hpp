#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim/random.hpp"
#include "sim/site/site_layout.hpp"

namespace alight::sim {

/// A place along a road, on one side of it.
struct Roadside {
  const Road* road = nullptr;
  double side = 1;     ///< 1: to the left of the road's direction, -1: to the right
  double along_m = 0;  ///< from the middle of the road's line

  /// The point that far from the middle of the road, into the side.
  Eigen::Vector2d at(double from_middle_m) const;
  /// Unit vector from the road into the side.
  Eigen::Vector2d outwards() const;
};

/// A place on either side of any of the roads, which are not none, up to half of `size_m` from the middle of its line.
Roadside draw_roadside(const std::vector<Road>& roads, double size_m, Random& random);

/// Whether another road runs less than 1 m from a place beside a road.
bool is_crossing(const std::vector<Road>& roads, const Road& road, const Eigen::Vector2d& p);

}  // namespace alight::sim
