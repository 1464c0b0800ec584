#include "sim/placing/movers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/objects/props.hpp"
#include "sim/placing/street_objects.hpp"

namespace alight::sim {
namespace {

/// Something that follows the ground from one point to another.
Mover on_way(const Terrain& terrain, std::size_t mesh, const Eigen::Vector3f& tint_rgb,
             const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  constexpr double kHeightStep_m = 0.5;
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kHeightStep_m)));
  std::vector<double> heights_m;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from + (to - from) * (static_cast<double>(i) / steps);
    heights_m.push_back(terrain.height_m(p.x(), p.y()));
  }
  return Mover(mesh, tint_rgb, from, to, std::move(heights_m));
}

/// Whole metres that the detailed square goes on from a point.
double room_m(double half_m, const Eigen::Vector2d& from, const Eigen::Vector2d& along) {
  double room_m = 0;
  while ((from + along * (room_m + 1)).cwiseAbs().maxCoeff() < half_m) room_m += 1;
  return room_m;
}

std::size_t add_person_mesh(SurfaceTable& surfaces, ObjectPlacer& placer) {
  return placer.add_mesh(person(surfaces.add(Material::kCarPaint)));
}

}  // namespace

std::vector<Mover> drive_traffic(const WorldSpec& spec, const std::vector<Road>& roads,
                                 SurfaceTable& surfaces, ObjectPlacer& placer) {
  constexpr int kCars = 8;
  std::vector<Mover> cars;
  if (roads.empty()) return cars;
  Random random = spec.stream(BuildStep::kTraffic);
  const std::size_t mesh = add_car_mesh(surfaces, placer);
  for (int i = 0; i < spec.scaled(kCars); ++i) {
    const Road& road = random.pick(roads);
    const double side = random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d along = side * road.line.direction();
    const Eigen::Vector2d lane = -left_of(along) * (0.25 * road.width_m);
    const Eigen::Vector2d middle = road.line.nearest({0, 0}) + lane;
    const double ahead_m = room_m(spec.half_m(), middle, along);
    const double behind_m = room_m(spec.half_m(), middle, -along);
    const double speed_mps = random.uniform(4, 10);
    const double under_way_s = random.uniform(0, 1) * (ahead_m + behind_m) / speed_mps;
    if (ahead_m + behind_m < 10) continue;
    cars.push_back(on_way(placer.terrain(), mesh, {.75F, .75F, .78F}, middle - along * behind_m,
                          middle + along * ahead_m));
    cars.back().set_pace(-under_way_s, speed_mps, AtWaysEnd::kAnew);
  }
  return cars;
}

std::vector<Mover> walk_people(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer) {
  constexpr int kPeople = 24;
  constexpr int kAttempts = 30;
  constexpr double kBody_m = 0.4;
  Random random = spec.stream(BuildStep::kPeople);
  const std::size_t mesh = add_person_mesh(surfaces, placer);
  std::vector<Mover> people;
  for (int i = 0; i < spec.scaled(kPeople); ++i) {
    const auto from = placer.plan().find_free(random, kBody_m, spec.half_m(), kAttempts);
    const double length_m = random.uniform(5, 25);
    const Eigen::Vector2d along = heading(random.uniform(0, kTwoPi));
    const double speed_mps = random.uniform(0.7, 1.6);
    const Eigen::Vector3f tint{random.uniformf(.1, 1), random.uniformf(.1, 1), random.uniformf(.1, 1)};
    if (!from) continue;
    double free_m = 0;  // nobody walks through a wall
    while (free_m < length_m && placer.plan().is_free(*from + along * (free_m + 0.5), kBody_m)) free_m += 0.5;
    if (free_m < 2) continue;
    people.push_back(on_way(placer.terrain(), mesh, tint, *from, *from + along * free_m));
    people.back().set_pace(-free_m, speed_mps, AtWaysEnd::kBack);
  }
  return people;
}

Mover send_visitor(const VisitorConfig& visitor, SurfaceTable& surfaces, ObjectPlacer& placer) {
  const std::size_t mesh =
      visitor.kind == VisitorKind::kCar ? add_car_mesh(surfaces, placer) : add_person_mesh(surfaces, placer);
  Mover mover = on_way(placer.terrain(), mesh, {.8F, .1F, .1F}, {visitor.from_x_m, visitor.from_y_m},
                       {visitor.to_x_m, visitor.to_y_m});
  mover.set_pace(visitor.begin_s, visitor.speed_mps, AtWaysEnd::kStay);
  return mover;
}

}  // namespace alight::sim
