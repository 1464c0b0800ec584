#include "sim/placing/power_lines.hpp"

#include "sim/objects/props.hpp"

namespace alight::sim {
namespace {

constexpr double kMastRadius_m = 0.3;

PropSurfaces line_surfaces(SurfaceTable& surfaces) {
  PropSurfaces s;
  s.wood = surfaces.add(Material::kWood, {0.6F, 0.6F, 0.6F});
  s.metal = surfaces.add(Material::kMetal, {0.25F, 0.25F, 0.25F});
  return s;
}

/// Takes the ground of a mast. @returns its foot
Eigen::Vector3f take_mast_ground(const Eigen::Vector2d& p, ObjectPlacer& placer) {
  placer.plan().occupy_disc(p, kMastRadius_m);
  return placer.on_ground(p);
}

}  // namespace

void string_power_line(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
                       ObjectPlacer& placer) {
  if (!spec.look().power_line || roads.empty()) return;
  constexpr double kSpan_m = 32;
  const PropSurfaces s = line_surfaces(surfaces);
  const Road& road = roads.front();
  const Eigen::Vector2d along = road.line.direction();
  const Eigen::Vector2d across = left_of(along);
  const double length_m = (road.line.b - road.line.a).norm();
  std::vector<Eigen::Vector3f> feet;
  for (double s_m = spec.stream(BuildStep::kPowerLine).uniform(0, kSpan_m); s_m < length_m; s_m += kSpan_m) {
    const Eigen::Vector2d p = road.line.a + along * s_m + across * (0.5 * road.width_m + 1.6);
    if (!spec.is_outside(p)) feet.push_back(take_mast_ground(p, placer));
  }
  add_power_line(feet, s, placer.fixed());
}

void string_wires(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer) {
  constexpr int kLines = 2;
  constexpr double kSpan_m = 26;
  Random random = spec.stream(BuildStep::kWires);
  const PropSurfaces s = line_surfaces(surfaces);
  for (int i = 0; i < kLines; ++i) {
    const Eigen::Vector2d along = heading(random.uniform(0, kTwoPi));
    const Eigen::Vector2d middle = left_of(along) * random.uniform(-0.15, 0.15) * spec.size_m();
    std::vector<Eigen::Vector3f> feet;
    for (double at_m = -spec.half_m(); at_m < spec.half_m(); at_m += kSpan_m) {
      const Eigen::Vector2d p = middle + along * at_m;
      if (spec.is_outside(p) || !placer.plan().is_free(p, kMastRadius_m)) continue;
      feet.push_back(take_mast_ground(p, placer));
    }
    add_power_line(feet, s, placer.fixed());
  }
}

}  // namespace alight::sim
