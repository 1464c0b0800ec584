#pragma once

#include "sim/objects/surface_table.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Divides the ground into fields, where the look has fields, and into blocks between the streets of a grid, which have
/// to be there already.
void lay_plots(const WorldSpec& spec, SurfaceTable& surfaces, SiteLayout& layout);

}  // namespace alight::sim
