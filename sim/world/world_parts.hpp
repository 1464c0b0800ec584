#pragma once

#include <optional>
#include <vector>

#include "sim/objects/mover.hpp"
#include "sim/objects/terrain_mesh.hpp"
#include "sim/objects/triangle_mesh.hpp"

namespace alight::sim {

/// What a world consists of.
struct WorldParts {
  std::vector<TriangleMesh> meshes;
  std::vector<Placement> placements;
  std::vector<Surface> surfaces;
  std::vector<Mover> movers;
  std::optional<Terrain> terrain;  ///< none in a world of given triangles
};

}  // namespace alight::sim
