#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Rows of plants on the plots that have crops, open where something else stands.
void grow_crops(const WorldSpec& spec, const std::vector<Plot>& plots, SurfaceTable& surfaces,
                ObjectPlacer& placer);

/// Bales of straw on free ground. Draws from the caller's stream, which others share.
void lay_bales(const WorldSpec& spec, Random& random, SurfaceTable& surfaces, ObjectPlacer& placer);

}  // namespace alight::sim
