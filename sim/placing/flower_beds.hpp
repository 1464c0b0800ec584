#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Beds with a stone edging of 10 to 15 cm in open ground, the clearings too.
void lay_beds(const WorldSpec& spec, const std::vector<Levelling>& clearings, SurfaceTable& surfaces,
              ObjectPlacer& placer);

}  // namespace alight::sim
