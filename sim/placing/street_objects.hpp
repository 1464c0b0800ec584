#pragma once

#include <vector>

#include "sim/objects/surface_table.hpp"
#include "sim/placing/object_placer.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Kerbs along both sides of every street of a grid, open where another street crosses.
void add_kerbs(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
               ObjectPlacer& placer);

/// Street lamps beside the roads, their arms over the road. Draws from the caller's stream, which others share.
void set_lamps(const WorldSpec& spec, const std::vector<Road>& roads, Random& random, SurfaceTable& surfaces,
               ObjectPlacer& placer);

/// Adds the mesh of a car and its surfaces. @returns the mesh's index
std::size_t add_car_mesh(SurfaceTable& surfaces, ObjectPlacer& placer);

/// Cars in several colours along the edges of the roads, facing as traffic on the right does.
void park_cars(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
               ObjectPlacer& placer);

}  // namespace alight::sim
