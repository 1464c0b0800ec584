#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// The look's boulders, on free ground.
void scatter_boulders(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer);

/// Stones that stand out by 20 to 30 cm across open ground, the clearings too. They take no ground.
void scatter_stones(const WorldSpec& spec, const std::vector<Levelling>& clearings, SurfaceTable& surfaces,
                    ObjectPlacer& placer);

}  // namespace alight::sim
