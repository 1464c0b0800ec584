#pragma once

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Broadleaf trees and conifers, each of a few kinds. Crowns may touch but not swallow each other.
void plant_trees(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer);

/// Bushes, and tufts of grass, which take no ground.
void plant_bushes_and_tufts(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer);

}  // namespace alight::sim
