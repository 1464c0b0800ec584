// WorldBuilder: everything that stands on the ground.
#include <algorithm>
#include <cmath>

#include "sim/objects/buildings.hpp"
#include "sim/objects/props.hpp"
#include "sim/objects/shapes.hpp"
#include "sim/objects/vegetation.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {}

void WorldBuilder::raise_buildings() {
  Random random = stream(20);
  for (const GroundRect& rect : building_rects_) {
    BuildingPlan plan;
    plan.rect = rect;
    plan.storeys = look_.min_storeys + random.below(look_.max_storeys - look_.min_storeys + 1);
    plan.flat_roof = random.chance(look_.flat_roof_share);
    plan.barn = look_.barns && random.chance(0.7);
    plan.base_height_m = terrain->height_m(rect.centre.x(), rect.centre.y());
    add_building(plan, random, fixed_, surfaces);
  }
}

void WorldBuilder::add_water() {
  constexpr int kCorners = 40;
  for (const Pond& pond : ponds_) {
    const std::uint16_t water = add_surface(Material::kWater);
    const auto corner = [&](int i) {
      const double angle = kTwoPi * i / kCorners;
      const Eigen::Vector2d p =
          pond.centre + pond.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      return Eigen::Vector3d(p.x(), p.y(), pond.level_m).cast<float>().eval();
    };
    const Eigen::Vector3f middle =
        Eigen::Vector3d(pond.centre.x(), pond.centre.y(), pond.level_m).cast<float>();
    for (int i = 0; i < kCorners; ++i) fixed_.add_triangle(middle, corner(i), corner(i + 1), water);
  }
}

// Along both sides of every street, open where another street crosses.
void WorldBuilder::add_kerbs() {
  if (look_.road_net != RoadNet::kGrid) return;
  constexpr double kStep_m = 2.0;
  const std::uint16_t stone = add_surface(Material::kConcrete, {0.9F, 0.9F, 0.9F});
  for (const Road& road : roads_) {
    const Eigen::Vector2d along = road.line.direction();
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const double side : {-0.5, 0.5}) {
      std::vector<StripSection> sections;
      const auto end_strip = [&] {
        add_strip(fixed_, sections, stone, stone);
        sections.clear();
      };
      const double length_m = (road.line.b - road.line.a).norm();
      for (double s = 0; s <= length_m; s += kStep_m) {
        const Eigen::Vector2d p = road.line.a + along * s + across * (side * (road.width_m + 0.15));
        const bool outside = p.cwiseAbs().maxCoeff() > half_m();
        const bool crossing = std::any_of(roads_.begin(), roads_.end(), [&](const Road& other) {
          return &other != &road && (p - other.line.nearest(p)).norm() < 0.5 * other.width_m + 1.0;
        });
        if (outside || crossing) {
          end_strip();
        } else {
          sections.push_back({on_ground(p), 0.15F, 0.15F, 0.13F});
        }
      }
      end_strip();
    }
  }
}

void WorldBuilder::string_power_line() {
  if (!look_.power_line || roads_.empty()) return;
  PropSurfaces s;
  s.wood = add_surface(Material::kWood, {0.6F, 0.6F, 0.6F});
  s.metal = add_surface(Material::kMetal, {0.25F, 0.25F, 0.25F});
  constexpr double kSpan_m = 32;
  const Road& road = roads_.front();
  const Eigen::Vector2d along = road.line.direction();
  const Eigen::Vector2d across(-along.y(), along.x());
  const double length_m = (road.line.b - road.line.a).norm();
  std::vector<Eigen::Vector3f> feet;
  for (double s_m = stream(21).uniform(0, kSpan_m); s_m < length_m; s_m += kSpan_m) {
    const Eigen::Vector2d p = road.line.a + along * s_m + across * (0.5 * road.width_m + 1.6);
    if (p.cwiseAbs().maxCoeff() > half_m()) continue;
    feet.push_back(on_ground(p));
    plan_.occupy_disc(p, 0.3);
  }
  add_power_line(feet, s, fixed_);
}

void WorldBuilder::set_lamps_and_bales() {
  Random random = stream(22);
  PropSurfaces s;
  s.metal = add_surface(Material::kMetal, {0.5F, 0.5F, 0.5F});
  s.straw = add_surface(Material::kDryGrass, {1.5F, 1.35F, 1.2F});
  // Straw on the ground is no ground: as wood it does not bear a vehicle.
  surfaces[s.straw].material = Material::kWood;
  const std::size_t lamp_mesh = add_mesh(lamp(s));
  const std::size_t bale_mesh = add_mesh(bale(s));
  for (int i = 0; i < scaled(look_.lamps) && !roads_.empty(); ++i) {
    const Road& road = roads_[static_cast<std::size_t>(random.below(static_cast<int>(roads_.size())))];
    const Eigen::Vector2d along = road.line.direction();
    const Eigen::Vector2d across(-along.y(), along.x());
    const double side = random.chance(0.5) ? 1 : -1;
    const double s_m = (random.uniform(-0.5, 0.5)) * config_.size_m;
    const Eigen::Vector2d middle = 0.5 * (road.line.a + road.line.b);
    const Eigen::Vector2d p = middle + along * s_m + across * (side * (0.5 * road.width_m + 0.8));
    const bool crossing = std::any_of(roads_.begin(), roads_.end(), [&](const Road& other) {
      return &other != &road && (p - other.line.nearest(p)).norm() < 0.5 * other.width_m + 1.0;
    });
    if (p.cwiseAbs().maxCoeff() > half_m() || crossing) continue;
    put(lamp_mesh, p, 0, std::atan2(-side * across.y(), -side * across.x()), 1);
  }
  scatter(random, {bale_mesh}, scaled(look_.bales), 0.95, 1.05, 1.2, true, 0.03);
}

PropSurfaces WorldBuilder::car_surfaces() {
  PropSurfaces s;
  s.paint = add_surface(Material::kCarPaint);
  s.glass = add_surface(Material::kGlass);
  s.rubber = add_surface(Material::kAsphalt, {0.4F, 0.4F, 0.4F});
  surfaces[s.rubber].material = Material::kMetal;
  surfaces[s.rubber].tint_rgb = {0.08F, 0.08F, 0.08F};
  return s;
}

void WorldBuilder::park_cars() {
  Random random = stream(23);
  const std::size_t mesh = add_mesh(car(car_surfaces()));
  const std::vector<Eigen::Vector3f> paints = {{1.5F, 1.5F, 1.5F}, {.06F, .06F, .07F}, {.7F, .7F, .72F},
                                               {.8F, .08F, .07F},  {.1F, .2F, .7F},    {.35F, .36F, .38F}};
  for (int i = 0; i < scaled(look_.cars) && !roads_.empty(); ++i) {
    const Road& road = roads_[static_cast<std::size_t>(random.below(static_cast<int>(roads_.size())))];
    const Eigen::Vector2d along = road.line.direction();
    const Eigen::Vector2d across(-along.y(), along.x());
    const double side = random.chance(0.5) ? 1 : -1;
    const double s_m = random.uniform(-0.5, 0.5) * config_.size_m;
    const double lane_m = std::max(0.5 * road.width_m - 1.2, 0.0);
    const Eigen::Vector2d p = 0.5 * (road.line.a + road.line.b) + along * s_m + across * (side * lane_m);
    const Eigen::Vector3f& paint =
        paints[static_cast<std::size_t>(random.below(static_cast<int>(paints.size())))];
    if (p.cwiseAbs().maxCoeff() > half_m()) continue;
    put(mesh, p, 0, std::atan2(along.y(), along.x()) + (side > 0 ? kTwoPi / 2 : 0.0), 1, paint);
  }
}

void WorldBuilder::plant_trees() {
  constexpr int kKinds = 4;
  Random random = stream(24);
  std::vector<std::size_t> broadleaves;
  std::vector<std::size_t> conifers;
  for (int i = 0; i < kKinds; ++i) {
    PlantSurfaces s;
    s.bark = add_surface(Material::kBark);
    s.leaves = add_surface(Material::kFoliage);
    s.inner_leaves = add_surface(Material::kFoliage, {0.5F, 0.55F, 0.5F});
    broadleaves.push_back(add_mesh(broadleaf_tree(s, random)));
    s.leaves = add_surface(Material::kNeedles);
    s.inner_leaves = add_surface(Material::kNeedles, {0.55F, 0.55F, 0.55F});
    conifers.push_back(add_mesh(conifer(s, random)));
  }
  const int count = scaled(look_.trees);
  const int conifer_count = static_cast<int>(std::lround(count * look_.conifer_share));
  constexpr double kClearRadius = 0.24;  // crowns may touch but not swallow each other
  scatter(random, conifers, conifer_count, look_.min_tree_m, look_.max_tree_m * 1.2, kClearRadius * 0.7, true,
          0.01);
  scatter(random, broadleaves, count - conifer_count, look_.min_tree_m, look_.max_tree_m, kClearRadius, true,
          0.01);
}

std::vector<std::size_t> WorldBuilder::boulder_kinds(Random& random, int count, double max_shade) {
  std::vector<std::size_t> kinds;
  for (int i = 0; i < count; ++i) {
    const float shade = random.uniformf(0.7, max_shade);
    kinds.push_back(
        add_mesh(boulder(add_surface(Material::kRock, Eigen::Vector3f::Constant(shade)), random)));
  }
  return kinds;
}

void WorldBuilder::scatter_boulders() {
  Random random = stream(25);
  const std::vector<std::size_t> kinds = boulder_kinds(random, 6, 1.3);
  scatter(random, kinds, scaled(look_.boulders), 0.12, look_.max_boulder_m, 1.1, true, 0.2);
}

void WorldBuilder::plant_small() {
  constexpr int kKinds = 3;
  Random random = stream(26);
  std::vector<std::size_t> bushes;
  std::vector<std::size_t> tufts;
  for (int i = 0; i < kKinds; ++i) {
    PlantSurfaces s;
    s.leaves = add_surface(Material::kFoliage, {1.1F, 1.05F, 0.9F});
    s.inner_leaves = add_surface(Material::kFoliage, {0.55F, 0.6F, 0.5F});
    bushes.push_back(add_mesh(bush(s, random)));
    tufts.push_back(add_mesh(tuft(add_surface(Material::kFoliage, {1.6F, 1.4F, 1.2F}), random)));
  }
  scatter(random, bushes, scaled(look_.bushes), 0.7, 3.0, 0.5, true, 0.03);
  scatter(random, tufts, scaled(look_.tufts), 0.5, 1.3, 0.3, false, 0.02);
}

void WorldBuilder::grow_crops() {
  constexpr double kRowDistance_m = 0.75;
  Random random = stream(27);
  const std::uint16_t leaves = add_surface(Material::kCrop);
  for (const Area& area : areas_) {
    if (!area.crop_rows) continue;
    for (double v = -area.rect.half_v_m + 0.6; v < area.rect.half_v_m - 0.5; v += kRowDistance_m) {
      grow_crop_row(area, v, leaves, random);
    }
  }
}

void WorldBuilder::grow_crop_row(const Area& area, double v_m, std::uint16_t surface, Random& random) {
  constexpr double kPlant_m = 0.4;
  std::vector<StripSection> sections;
  const auto end_row = [&] {
    add_strip(fixed_, sections, surface, surface);
    sections.clear();
  };
  for (double u = -area.rect.half_u_m + 0.5; u < area.rect.half_u_m - 0.5; u += kPlant_m) {
    const Eigen::Vector2d p = area.rect.at(u, v_m + random.uniform(-0.05, 0.05));
    const float height_m = random.uniformf(0.3, 0.55);
    const float top_m = random.uniformf(0.08, 0.25);
    if (p.cwiseAbs().maxCoeff() > half_m() || !plan_.is_free(p, 0.3)) {
      end_row();
    } else {
      sections.push_back({on_ground(p), 0.48F, top_m, height_m});
    }
  }
  end_row();
}

}  // namespace alight::sim
