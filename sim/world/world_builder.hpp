#pragma once

#include "sim/spec/world_config.hpp"
#include "sim/world/world_parts.hpp"

namespace alight::sim {

/// Lays out a place on paper first (roads, plots, clearings, ponds, buildings), then shapes the ground to the layout,
/// paints it, and puts everything on it that stands or moves.
WorldParts build_world(const WorldConfig& config);

}  // namespace alight::sim
