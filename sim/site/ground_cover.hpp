#pragma once

#include <cstdint>

#include "sim/objects/surface_table.hpp"
#include "sim/objects/terrain_mesh.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Indices of the surfaces that lie on ground which is neither road nor plot.
struct CoverSurfaces {
  std::uint16_t ground = 0;
  std::uint16_t ground_alt = 0;
  std::uint16_t patches = 0;
  std::uint16_t shoulder = 0;  ///< beside roads and around buildings
  std::uint16_t mud = 0;       ///< in and around ponds
};

/// Enters the surfaces that cover the ground of a world.
CoverSurfaces add_cover_surfaces(const WorldSpec& spec, SurfaceTable& surfaces);

/// Paints the terrain's cover map: where several things lie on a point, roads come first, then their shoulders, ponds,
/// what is around buildings, plots, natural ground.
void paint_ground(const WorldSpec& spec, const SiteLayout& layout, const CoverSurfaces& covers,
                  Terrain& terrain);

}  // namespace alight::sim
