#include "sim/world/world_builder.hpp"

#include <utility>

#include "sim/placing/field_objects.hpp"
#include "sim/placing/flower_beds.hpp"
#include "sim/placing/movers.hpp"
#include "sim/placing/plants.hpp"
#include "sim/placing/pond_water.hpp"
#include "sim/placing/power_lines.hpp"
#include "sim/placing/site_buildings.hpp"
#include "sim/placing/stones.hpp"
#include "sim/placing/street_objects.hpp"
#include "sim/site/building_layout.hpp"
#include "sim/site/ground_cover.hpp"
#include "sim/site/ground_shape.hpp"
#include "sim/site/landform_layout.hpp"
#include "sim/site/plot_layout.hpp"
#include "sim/site/relief.hpp"
#include "sim/site/road_layout.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {
namespace {

SiteLayout lay_out_site(const WorldSpec& spec, const Relief& relief, SurfaceTable& surfaces) {
  SiteLayout layout(spec.size_m());
  layout.yaw_rad = spec.stream(BuildStep::kHeading).uniform(0, kTwoPi);
  lay_roads(spec, surfaces, layout);
  lay_plots(spec, surfaces, layout);
  lay_clearings(spec, relief, layout);
  lay_ponds(spec, relief, layout);
  lay_building_grounds(spec, relief, layout);
  lay_mounds(spec, layout);
  return layout;
}

/// What belongs to the look. The order is part of every world: what comes first takes the ground.
void place_objects(const WorldSpec& spec, const SiteLayout& layout, SurfaceTable& surfaces,
                   ObjectPlacer& placer) {
  raise_buildings(spec, layout.building_grounds, surfaces, placer);
  add_water(layout.ponds, surfaces, placer.fixed());
  add_kerbs(spec, layout.roads, surfaces, placer);
  string_power_line(spec, layout.roads, surfaces, placer);
  Random random = spec.stream(BuildStep::kLampsAndBales);
  set_lamps(spec, layout.roads, random, surfaces, placer);
  lay_bales(spec, random, surfaces, placer);
  park_cars(spec, layout.roads, surfaces, placer);
  plant_trees(spec, surfaces, placer);
  scatter_boulders(spec, surfaces, placer);
  plant_bushes_and_tufts(spec, surfaces, placer);
  grow_crops(spec, layout.plots, surfaces, placer);
}

void place_hardships(const WorldSpec& spec, const SiteLayout& layout, SurfaceTable& surfaces,
                     ObjectPlacer& placer) {
  if (spec.has(Hardship::kWires)) string_wires(spec, surfaces, placer);
  if (spec.has(Hardship::kKerbs)) lay_beds(spec, layout.clearings, surfaces, placer);
  if (spec.has(Hardship::kStones)) scatter_stones(spec, layout.clearings, surfaces, placer);
}

std::vector<Mover> make_movers(const WorldSpec& spec, const SiteLayout& layout, SurfaceTable& surfaces,
                               ObjectPlacer& placer) {
  std::vector<Mover> movers;
  if (spec.has(Hardship::kTraffic)) movers = drive_traffic(spec, layout.roads, surfaces, placer);
  if (spec.has(Hardship::kPeople)) {
    const std::vector<Mover> people = walk_people(spec, surfaces, placer);
    movers.insert(movers.end(), people.begin(), people.end());
  }
  if (spec.visitor().kind != VisitorKind::kNone) {
    movers.push_back(send_visitor(spec.visitor(), surfaces, placer));
  }
  return movers;
}

}  // namespace

WorldParts build_world(const WorldConfig& config) {
  const WorldSpec spec(config);
  const Relief relief(spec.look().relief, spec.seed());
  SurfaceTable surfaces(spec.seed());
  const CoverSurfaces covers = add_cover_surfaces(spec, surfaces);
  SiteLayout layout = lay_out_site(spec, relief, surfaces);

  Terrain terrain = shape_ground(spec.size_m(), covers.ground, relief, layout);
  paint_ground(spec, layout, covers, terrain);

  ObjectPlacer placer(spec, terrain, layout.plan);
  placer.add_in_place(terrain.mesh());
  place_objects(spec, layout, surfaces, placer);
  place_hardships(spec, layout, surfaces, placer);
  WorldParts parts;
  parts.movers = make_movers(spec, layout, surfaces, placer);
  placer.add_in_place(std::move(placer.fixed()));

  parts.meshes = std::move(placer.meshes());
  parts.placements = std::move(placer.placements());
  parts.surfaces = surfaces.all();
  parts.terrain = std::move(terrain);
  return parts;
}

}  // namespace alight::sim
