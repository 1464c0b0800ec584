#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Masts and wires along the first road, if the look has any.
void string_power_line(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
                       ObjectPlacer& placer);

/// Two lines between the trees and houses, over places where one would land.
void string_wires(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer);

}  // namespace alight::sim
