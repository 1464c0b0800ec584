#include "sim/site/building_layout.hpp"

#include <algorithm>

namespace alight::sim {
namespace {

GroundRect draw_walls(const WorldSpec& spec, double yaw_rad, Random& random) {
  const double half_m = spec.half_m();
  GroundRect rect;
  rect.centre = {random.uniform(-half_m, half_m), random.uniform(-half_m, half_m)};
  const bool tall = spec.look().max_storeys > 3;
  rect.half_u_m = tall ? random.uniform(6, 12) : random.uniform(4.5, 7.5);
  rect.half_v_m = tall ? random.uniform(5, 9) : random.uniform(3.5, 5);
  const double askew_rad = tall ? 0.0 : random.uniform(-0.15, 0.15);
  rect.u_axis = heading(yaw_rad + (random.chance(0.5) ? kTwoPi / 4 : 0.0) + askew_rad);
  return rect;
}

/// To the middle of the nearest road; 0 where there is none.
double road_distance_m(const std::vector<Road>& roads, const Eigen::Vector2d& p) {
  if (roads.empty()) return 0;
  double nearest_m = 1e9;
  for (const Road& road : roads) nearest_m = std::min(nearest_m, (p - road.line.nearest(p)).norm());
  return nearest_m;
}

}  // namespace

void lay_building_grounds(const WorldSpec& spec, const Relief& relief, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kBuildingGrounds);
  const int count = spec.scaled(spec.look().buildings);
  std::vector<Levelling>& grounds = layout.building_grounds;
  for (int attempt = 0; attempt < 60 * count && static_cast<int>(grounds.size()) < count; ++attempt) {
    const GroundRect walls = draw_walls(spec, layout.yaw_rad, random);
    if (road_distance_m(layout.roads, walls.centre) > 28 && !random.chance(0.12)) continue;
    if (!layout.plan.is_free(walls, 2.5)) continue;
    layout.plan.occupy_rect(walls, 1.5);
    Levelling ground;
    ground.rect = walls;
    ground.margin_m = 1.2;
    ground.height_m = relief.smooth_m(walls.centre);
    grounds.push_back(ground);
  }
}

}  // namespace alight::sim
