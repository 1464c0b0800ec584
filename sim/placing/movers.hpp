#pragma once

#include <vector>

#include "sim/objects/mover.hpp"
#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Cars, one after the other in the middle of its lane, from one end of the detailed square to the other, anew each time.
std::vector<Mover> drive_traffic(const WorldSpec& spec, const std::vector<Road>& roads,
                                 SurfaceTable& surfaces, ObjectPlacer& placer);

/// People who walk to and fro over free ground, as far as nothing stands in their way.
std::vector<Mover> walk_people(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer);

/// The visitor of the configuration, which has to be one.
Mover send_visitor(const VisitorConfig& visitor, SurfaceTable& surfaces, ObjectPlacer& placer);

}  // namespace alight::sim
