// WorldBuilder: what moves.
#include <algorithm>
#include <cmath>

#include "sim/objects/props.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {

constexpr double kHeightStep_m = 0.5;  // between the heights that a mover follows

}  // namespace

void WorldBuilder::add_movers() {
  if (config_.hard.has(Hardship::kTraffic)) add_traffic();
  if (config_.hard.has(Hardship::kPeople)) add_people();
  if (config_.visitor.kind != VisitorKind::kNone) add_visitor();
}

Mover WorldBuilder::on_way(std::size_t mesh, const Eigen::Vector3f& tint, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) const {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kHeightStep_m)));
  std::vector<double> heights_m;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from + (to - from) * (static_cast<double>(i) / steps);
    heights_m.push_back(terrain->height_m(p.x(), p.y()));
  }
  return Mover(mesh, tint, from, to, std::move(heights_m));
}

/// One car after the other in the middle of its lane, from one end of the detailed square to the other.
void WorldBuilder::add_traffic() {
  constexpr int kCars = 8;
  if (roads_.empty()) return;
  Random random = stream(33);
  const std::size_t mesh = add_mesh(car(car_surfaces()));
  for (int i = 0; i < scaled(kCars); ++i) {
    const Road& road = roads_[static_cast<std::size_t>(random.below(static_cast<int>(roads_.size())))];
    const double side = random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d along = side * road.line.direction();
    const Eigen::Vector2d lane = Eigen::Vector2d(along.y(), -along.x()) * (0.25 * road.width_m);
    const Eigen::Vector2d middle = road.line.nearest({0, 0}) + lane;
    // As far as the square goes from there, both ways.
    double ahead_m = 0;
    double behind_m = 0;
    while ((middle + along * (ahead_m + 1)).cwiseAbs().maxCoeff() < half_m()) ahead_m += 1;
    while ((middle - along * (behind_m + 1)).cwiseAbs().maxCoeff() < half_m()) behind_m += 1;
    const double speed_mps = random.uniform(4, 10);
    const double under_way_s = random.uniform(0, 1) * (ahead_m + behind_m) / speed_mps;
    if (ahead_m + behind_m < 10) continue;
    movers.push_back(
        on_way(mesh, Eigen::Vector3f(.75F, .75F, .78F), middle - along * behind_m, middle + along * ahead_m));
    movers.back().set_pace(-under_way_s, speed_mps, AtWaysEnd::kAnew);
  }
}

void WorldBuilder::add_people() {
  constexpr int kPeople = 24;
  constexpr int kAttempts = 30;
  constexpr double kBody_m = 0.4;
  Random random = stream(34);
  const std::size_t mesh = add_mesh(person(add_surface(Material::kCarPaint)));
  for (int i = 0; i < scaled(kPeople); ++i) {
    const auto from = plan_.find_free(random, kBody_m, half_m(), kAttempts);
    const double length_m = random.uniform(5, 25);
    const Eigen::Vector2d along = heading(random.uniform(0, 2 * 3.14159265358979323846));
    const double speed_mps = random.uniform(0.7, 1.6);
    const Eigen::Vector3f tint(random.uniformf(.1, 1), random.uniformf(.1, 1), random.uniformf(.1, 1));
    if (!from) continue;
    double free_m = 0;  // nobody walks through a wall
    while (free_m < length_m && plan_.is_free(*from + along * (free_m + 0.5), kBody_m)) free_m += 0.5;
    if (free_m < 2) continue;
    movers.push_back(on_way(mesh, tint, *from, *from + along * free_m));
    movers.back().set_pace(-free_m, speed_mps, AtWaysEnd::kBack);
  }
}

void WorldBuilder::add_visitor() {
  const VisitorConfig& v = config_.visitor;
  const std::size_t mesh = v.kind == VisitorKind::kCar ? add_mesh(car(car_surfaces()))
                                                       : add_mesh(person(add_surface(Material::kCarPaint)));
  movers.push_back(on_way(mesh, {.8F, .1F, .1F}, {v.from_x_m, v.from_y_m}, {v.to_x_m, v.to_y_m}));
  movers.back().set_pace(v.begin_s, v.speed_mps, AtWaysEnd::kStay);
}

}  // namespace alight::sim
