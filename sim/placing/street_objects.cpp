#include "sim/placing/street_objects.hpp"

#include <algorithm>
#include <cmath>

#include "sim/objects/props.hpp"
#include "sim/objects/shapes.hpp"
#include "sim/placing/roadside.hpp"

namespace alight::sim {
namespace {

/// One side of a street.
void add_kerb(const WorldSpec& spec, const std::vector<Road>& roads, const Road& road, double side,
              std::uint16_t stone, ObjectPlacer& placer) {
  constexpr double kStep_m = 2.0;
  const Eigen::Vector2d along = road.line.direction();
  const Eigen::Vector2d across = left_of(along);
  std::vector<StripSection> sections;
  const auto end_strip = [&] {
    add_strip(placer.fixed(), sections, stone, stone);
    sections.clear();
  };
  const double length_m = (road.line.b - road.line.a).norm();
  for (double s_m = 0; s_m <= length_m; s_m += kStep_m) {
    const Eigen::Vector2d p = road.line.a + along * s_m + across * (side * (road.width_m + 0.15));
    if (spec.is_outside(p) || is_crossing(roads, road, p)) {
      end_strip();
    } else {
      sections.push_back({placer.on_ground(p), 0.15F, 0.15F, 0.13F});
    }
  }
  end_strip();
}

}  // namespace

void add_kerbs(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
               ObjectPlacer& placer) {
  if (spec.look().road_net != RoadNet::kGrid) return;
  const std::uint16_t stone = surfaces.add(Material::kConcrete, {0.9F, 0.9F, 0.9F});
  for (const Road& road : roads) {
    for (const double side : {-0.5, 0.5}) add_kerb(spec, roads, road, side, stone, placer);
  }
}

void set_lamps(const WorldSpec& spec, const std::vector<Road>& roads, Random& random, SurfaceTable& surfaces,
               ObjectPlacer& placer) {
  PropSurfaces s;
  s.metal = surfaces.add(Material::kMetal, {0.5F, 0.5F, 0.5F});
  const std::size_t mesh = placer.add_mesh(lamp(s));
  if (roads.empty()) return;
  for (int i = 0; i < spec.scaled(spec.look().lamps); ++i) {
    const Roadside place = draw_roadside(roads, spec.size_m(), random);
    const Eigen::Vector2d p = place.at(0.5 * place.road->width_m + 0.8);
    if (spec.is_outside(p) || is_crossing(roads, *place.road, p)) continue;
    const Eigen::Vector2d outwards = place.outwards();
    placer.put(mesh, p, 0, std::atan2(-outwards.y(), -outwards.x()), 1);
  }
}

std::size_t add_car_mesh(SurfaceTable& surfaces, ObjectPlacer& placer) {
  PropSurfaces s;
  s.paint = surfaces.add(Material::kCarPaint);
  s.glass = surfaces.add(Material::kGlass);
  s.rubber = surfaces.add(Material::kMetal, {0.08F, 0.08F, 0.08F});
  return placer.add_mesh(car(s));
}

void park_cars(const WorldSpec& spec, const std::vector<Road>& roads, SurfaceTable& surfaces,
               ObjectPlacer& placer) {
  Random random = spec.stream(BuildStep::kParkedCars);
  const std::size_t mesh = add_car_mesh(surfaces, placer);
  if (roads.empty()) return;
  const std::vector<Eigen::Vector3f> paints = {{1.5F, 1.5F, 1.5F}, {.06F, .06F, .07F}, {.7F, .7F, .72F},
                                               {.8F, .08F, .07F},  {.1F, .2F, .7F},    {.35F, .36F, .38F}};
  for (int i = 0; i < spec.scaled(spec.look().cars); ++i) {
    const Roadside place = draw_roadside(roads, spec.size_m(), random);
    const Eigen::Vector2d p = place.at(std::max(0.5 * place.road->width_m - 1.2, 0.0));
    const Eigen::Vector3f& paint = random.pick(paints);
    if (spec.is_outside(p)) continue;
    const Eigen::Vector2d along = place.road->line.direction();
    const double turned_rad = place.side > 0 ? kTwoPi / 2 : 0.0;
    placer.put(mesh, p, 0, std::atan2(along.y(), along.x()) + turned_rad, 1, paint);
  }
}

}  // namespace alight::sim
