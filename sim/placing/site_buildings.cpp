#include "sim/placing/site_buildings.hpp"

#include "sim/objects/buildings.hpp"

namespace alight::sim {

void raise_buildings(const WorldSpec& spec, const std::vector<Levelling>& grounds, SurfaceTable& surfaces,
                     ObjectPlacer& placer) {
  const LookParameters& look = spec.look();
  Random random = spec.stream(BuildStep::kBuildings);
  for (const Levelling& ground : grounds) {
    BuildingPlan plan;
    plan.rect = ground.rect;
    plan.storeys = look.min_storeys + random.below(look.max_storeys - look.min_storeys + 1);
    plan.flat_roof = random.chance(look.flat_roof_share);
    plan.barn = look.barns && random.chance(0.7);
    plan.base_height_m = placer.terrain().height_m(plan.rect.centre.x(), plan.rect.centre.y());
    add_building(plan, random, placer.fixed(), surfaces);
  }
}

}  // namespace alight::sim
