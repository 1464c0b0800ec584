#pragma once

#include "sim/objects/ground_figures.hpp"
#include "sim/objects/surface_table.hpp"
#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"

namespace alight::sim {

/// One house, barn or block.
struct BuildingPlan {
  GroundRect rect;  ///< outer walls
  int storeys = 1;
  bool flat_roof = false;
  bool barn = false;         ///< wooden walls without windows
  double base_height_m = 0;  ///< of the ground that it stands on
};

constexpr double kStorey_m = 2.9;

/// Adds walls, roof and what stands on the roof to `mesh`, and their surfaces to `surfaces`.
void add_building(const BuildingPlan& plan, Random& random, TriangleMesh& mesh, SurfaceTable& surfaces);

}  // namespace alight::sim
