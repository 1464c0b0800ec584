#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/objects/triangle_mesh.hpp"
#include "sim/site/site_layout.hpp"

namespace alight::sim {

/// A level disc of water for every pond, as large as the pond, in world coordinates.
void add_water(const std::vector<Pond>& ponds, SurfaceTable& surfaces, TriangleMesh& mesh);

}  // namespace alight::sim
