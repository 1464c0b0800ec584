#pragma once

#include "sim/objects/surface_table.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// From street to street of a grid, metres.
inline constexpr double kBlock_m = 52;

/// Lays the look's net of roads along the layout's heading, beyond the square on both sides. A grid's streets take
/// turns: one along the heading, one across.
void lay_roads(const WorldSpec& spec, SurfaceTable& surfaces, SiteLayout& layout);

}  // namespace alight::sim
