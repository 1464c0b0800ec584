#pragma once

#include "sim/site/relief.hpp"
#include "sim/site/site_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// Level ground for the look's buildings on what is free: most keep to the roads, a few stand on their own. Fewer than
/// the look asks for where the ground is full.
void lay_building_grounds(const WorldSpec& spec, const Relief& relief, SiteLayout& layout);

}  // namespace alight::sim
