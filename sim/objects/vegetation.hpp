#pragma once

#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"

namespace alight::sim {

/// Surfaces of a plant. Leaves inside the crown are darker: less sky reaches them.
struct PlantSurfaces {
  std::uint16_t bark = 0;
  std::uint16_t leaves = 0;
  std::uint16_t inner_leaves = 0;
};

/// Plants stand on z = 0 at the origin. Trees are 1 m tall (scale them), the others about 1 m wide.
TriangleMesh broadleaf_tree(const PlantSurfaces& surfaces, Random& random);
TriangleMesh conifer(const PlantSurfaces& surfaces, Random& random);
TriangleMesh bush(const PlantSurfaces& surfaces, Random& random);
/// A tuft of high grass.
TriangleMesh tuft(std::uint16_t surface, Random& random);

}  // namespace alight::sim
