#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Raises a building of the look on every building's ground.
void raise_buildings(const WorldSpec& spec, const std::vector<Levelling>& grounds, SurfaceTable& surfaces,
                     ObjectPlacer& placer);

}  // namespace alight::sim
