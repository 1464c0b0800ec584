#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/objects/ground_figures.hpp"
#include "sim/site/site_plan.hpp"

namespace alight::sim {

/// A road on the plan; metres.
struct Road {
  GroundSegment line;
  double width_m = 0;
  std::uint16_t surface = 0;  ///< index into the world's surfaces, as below
};

/// A field or a city block: a cover of its own, perhaps rows of plants.
struct Plot {
  GroundRect rect;
  std::uint16_t surface = 0;
  bool crop_rows = false;
};

/// Ground made level (or evenly sloped) on a rectangle with round corners, blending into the relief around it.
struct Levelling {
  GroundRect rect;
  double margin_m = 0;   ///< level beyond the rectangle
  double falloff_m = 3;  ///< until the relief is as it was
  double height_m = 0;   ///< of its centre, in the relief
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
};

/// A pond on the plan; metres.
struct Pond {
  Eigen::Vector2d centre;
  double radius_m = 0;
  double level_m = 0;  ///< of the water, in the relief
};

/// A rise of the ground on the plan; metres.
struct Mound {
  Eigen::Vector2d centre;
  double sigma_m = 0;  ///< its height is a bell curve
  double height_m = 0;
};

/// A site on paper: what lies where, before the ground is shaped to it.
struct SiteLayout {
  explicit SiteLayout(double size_m) : plan(size_m) {}

  double yaw_rad = 0;  ///< of roads and fields, counter-clockwise from east
  std::vector<Road> roads;
  std::vector<Plot> plots;
  std::vector<Levelling> clearings;         ///< a point each, and a margin around it
  std::vector<Levelling> building_grounds;  ///< the rectangle is that of the outer walls
  std::vector<Pond> ponds;
  std::vector<Mound> mounds;
  SitePlan plan;  ///< which ground is taken
};

}  // namespace alight::sim
