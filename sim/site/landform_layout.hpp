#pragma once

#include "sim/site/relief.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Open level ground to land on, the first ones near the middle, where every flight passes; leaning or small and many
/// where the world is to be harder. Nobody leaves a round hole in a field of crops, if there is other ground.
void lay_clearings(const WorldSpec& spec, const Relief& relief, SiteLayout& layout);

/// Lays the ponds that the spec asks for.
void lay_ponds(const WorldSpec& spec, const Relief& relief, SiteLayout& layout);

/// Mounds lie on free ground and take none.
void lay_mounds(const WorldSpec& spec, SiteLayout& layout);

}  // namespace alight::sim
