#pragma once

#include <cstdint>

#include "sim/objects/terrain_mesh.hpp"
#include "sim/site/relief.hpp"
#include "sim/site/site_layout.hpp"

namespace alight::sim {

/// Height of the ground at a point, metres in the relief: the relief with its mounds, cut and filled for roads, level
/// ground and ponds, in that order.
double shaped_height_m(const Relief& relief, const SiteLayout& layout, const Eigen::Vector2d& p);

/// The ground of a layout, with one cover everywhere. The world's origin lies on it: all heights are lowered or raised
/// to that, those of the layout's ponds too.
/// @param size_m side of the detailed square
Terrain shape_ground(double size_m, std::uint16_t cover, const Relief& relief, SiteLayout& layout);

}  // namespace alight::sim
