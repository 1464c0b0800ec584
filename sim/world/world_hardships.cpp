// WorldBuilder: what makes a place harder to land in.
#include <cmath>

#include "geometry/frames.hpp"
#include "sim/objects/props.hpp"
#include "sim/objects/shapes.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {}

void WorldBuilder::add_hardships() {
  if (config_.hard.has(Hardship::kWires)) string_wires();
  if (config_.hard.has(Hardship::kKerbs)) lay_beds();
  if (config_.hard.has(Hardship::kStones)) scatter_stones();
}

/// The cover that lies on natural ground of a material.
Material WorldBuilder::ground_cover(Material material) const {
  const bool natural = material == Material::kGrass || material == Material::kDryGrass ||
                       material == Material::kSoil || material == Material::kGravel ||
                       material == Material::kRock;
  return natural && config_.hard.has(Hardship::kSnow) ? Material::kSnow : material;
}

/// Between the trees and houses, over places where one would land.
void WorldBuilder::string_wires() {
  constexpr int kLines = 2;
  constexpr double kSpan_m = 26;
  constexpr double kMastRadius_m = 0.3;
  Random random = stream(30);
  PropSurfaces s;
  s.wood = add_surface(Material::kWood, {0.6F, 0.6F, 0.6F});
  s.metal = add_surface(Material::kMetal, {0.25F, 0.25F, 0.25F});
  for (int i = 0; i < kLines; ++i) {
    const Eigen::Vector2d along = heading(random.uniform(0, kTwoPi));
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d middle = across * random.uniform(-0.15, 0.15) * config_.size_m;
    std::vector<Eigen::Vector3f> feet;
    for (double at_m = -half_m(); at_m < half_m(); at_m += kSpan_m) {
      const Eigen::Vector2d p = middle + along * at_m;
      if (p.cwiseAbs().maxCoeff() > half_m() || !plan_.is_free(p, kMastRadius_m)) continue;
      feet.push_back(on_ground(p));
      plan_.occupy_disc(p, kMastRadius_m);
    }
    add_power_line(feet, s, fixed_);
  }
}

void WorldBuilder::lay_beds() {
  constexpr int kBeds = 120;
  constexpr double kStep_m = 0.5;
  constexpr float kEdgeWidth_m = 0.12F;
  Random random = stream(31);
  const std::uint16_t stone = add_surface(Material::kConcrete, {0.8F, 0.8F, 0.78F});
  for (int i = 0; i < scaled(kBeds); ++i) {
    GroundRect bed;
    bed.half_u_m = random.uniform(1.2, 3.0);
    bed.half_v_m = random.uniform(0.8, 1.6);
    bed.u_axis = heading(random.uniform(0, kTwoPi));
    const float height_m = random.uniformf(0.10, 0.15);
    const auto at = find_open(random, std::hypot(bed.half_u_m, bed.half_v_m));
    if (!at) continue;
    bed.centre = *at;
    plan_.occupy_rect(bed, 0.3);
    const auto edge = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
      std::vector<StripSection> sections;
      const int steps = static_cast<int>(std::ceil((to - from).norm() / kStep_m));
      for (int k = 0; k <= steps; ++k)
        sections.push_back({on_ground(from + (to - from) * (static_cast<double>(k) / steps)), kEdgeWidth_m,
                            kEdgeWidth_m, height_m});
      add_strip(fixed_, sections, stone, stone);
    };
    const double u = bed.half_u_m, v = bed.half_v_m;
    edge(bed.at(-u, -v), bed.at(u, -v));
    edge(bed.at(u, -v), bed.at(u, v));
    edge(bed.at(u, v), bed.at(-u, v));
    edge(bed.at(-u, v), bed.at(-u, -v));
  }
}

void WorldBuilder::scatter_stones() {
  constexpr int kStones = 900;
  constexpr int kKinds = 4;
  Random random = stream(32);
  const std::vector<std::size_t> kinds = boulder_kinds(random, kKinds, 1.2);
  for (int i = 0; i < scaled(kStones); ++i) {
    const double radius_m = random.uniform(0.13, 0.19);  // stands out by 20 to 30 cm
    const auto at = find_open(random, radius_m);
    const auto kind = kinds[static_cast<std::size_t>(random.below(kKinds))];
    const double yaw_rad = random.uniform(0, kTwoPi);
    if (at) put(kind, *at, -0.3 * radius_m, yaw_rad, 1.15 * radius_m);
  }
}

/// Ground where nothing stands, the levelled clearings too, which are kept free of everything else.
std::optional<Eigen::Vector2d> WorldBuilder::find_open(Random& random, double radius_m) const {
  constexpr int kAttempts = 30;
  if (!clearings_.empty() && random.chance(0.25)) {
    const Levelling& l =
        levellings_[clearings_[static_cast<std::size_t>(random.below(static_cast<int>(clearings_.size())))]];
    const double reach_m = std::max(0.0, l.margin_m - radius_m) * std::sqrt(random.uniform());
    return l.rect.centre + reach_m * heading(random.uniform(0, kTwoPi));
  }
  return plan_.find_free(random, radius_m, half_m(), kAttempts);
}

}  // namespace alight::sim
