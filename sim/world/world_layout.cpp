// WorldBuilder: what lies where, before anything is built.
#include <algorithm>
#include <cmath>

#include "geometry/frames.hpp"
#include "sim/objects/buildings.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {
constexpr double kHalfPi = 1.5707963267948966;
constexpr double kBlock_m = 52;  // from street to street
}  // namespace

void WorldBuilder::add_road(const Eigen::Vector2d& through, double yaw_rad) {
  const Eigen::Vector2d along = heading(yaw_rad);
  const double reach_m = 1.5 * config_.size_m;
  Road road;
  road.line = {through - along * reach_m, through + along * reach_m};
  road.width_m = look_.road_width_m;
  const bool has_lanes = look_.road == Material::kAsphalt;
  road.surface = add_framed_surface(look_.road, road.line.a, along, has_lanes ? road.width_m : 0.0);
  plan_.occupy_segment(road.line, 0.5 * road.width_m + (look_.road_net == RoadNet::kGrid ? 2.5 : 0.7));
  roads_.push_back(road);
}

void WorldBuilder::lay_roads() {
  Random random = stream(3);
  const double offset_m = 0.16 * config_.size_m;
  const Eigen::Vector2d along = heading(yaw_rad_);
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d off_centre = across * random.uniform(-offset_m, offset_m);
  switch (look_.road_net) {
    case RoadNet::kNone:
      break;
    case RoadNet::kTrack:
      add_road(off_centre, yaw_rad_);
      break;
    case RoadNet::kCross:
      add_road(off_centre, yaw_rad_);
      add_road(along * random.uniform(-offset_m, offset_m), yaw_rad_ + random.uniform(1.1, 1.9));
      break;
    case RoadNet::kGrid: {
      const int streets = static_cast<int>(std::ceil(0.75 * config_.size_m / kBlock_m));
      const double shift_m = random.uniform(0, kBlock_m);
      for (int i = -streets; i <= streets; ++i) {
        add_road(across * (i * kBlock_m + shift_m), yaw_rad_);
        add_road(along * (i * kBlock_m + shift_m), yaw_rad_ + kHalfPi);
      }
      break;
    }
  }
}

std::vector<double> WorldBuilder::grid_lines(Random& random, double min_m, double max_m) const {
  std::vector<double> lines = {-0.8 * config_.size_m};
  while (lines.back() < 0.8 * config_.size_m) lines.push_back(lines.back() + random.uniform(min_m, max_m));
  return lines;
}

void WorldBuilder::lay_areas() {
  Random random = stream(4);
  if (look_.fields) lay_fields(random);
  if (look_.road_net == RoadNet::kGrid) lay_blocks(random);
}

void WorldBuilder::lay_fields(Random& random) {
  constexpr double kBalk_m = 2.2;  // grass between two fields
  const std::vector<double> u = grid_lines(random, 24, 46);
  const std::vector<double> v = grid_lines(random, 24, 46);
  const Eigen::Vector2d u_axis = heading(yaw_rad_);
  const Eigen::Vector2d v_axis(-u_axis.y(), u_axis.x());
  for (std::size_t i = 0; i + 1 < u.size(); ++i) {
    for (std::size_t k = 0; k + 1 < v.size(); ++k) {
      Area field;
      field.rect.centre = u_axis * (0.5 * (u[i] + u[i + 1])) + v_axis * (0.5 * (v[k] + v[k + 1]));
      field.rect.half_u_m = 0.5 * (u[i + 1] - u[i]) - 0.5 * kBalk_m;
      field.rect.half_v_m = 0.5 * (v[k + 1] - v[k]) - 0.5 * kBalk_m;
      field.rect.u_axis = u_axis;
      const double kind = random.uniform();
      field.crop_rows = kind < 0.32;
      const bool bare = kind < 0.55;
      const bool stubble = kind < 0.8;
      const Material material = bare ? Material::kSoil : (stubble ? Material::kDryGrass : Material::kGrass);
      field.surface =
          add_framed_surface(ground_cover(material), field.rect.centre, u_axis, bare ? 0.75 : 0.0);
      const float shade = random.uniformf(0.8, 1.25);
      surfaces[field.surface].tint_rgb = {shade * random.uniformf(0.9, 1.1), shade, shade};
      areas_.push_back(field);
    }
  }
}

void WorldBuilder::lay_blocks(Random& random) {
  const std::vector<Material> kinds = {Material::kGrass, Material::kGrass, Material::kPaving,
                                       Material::kAsphalt, Material::kGravel};
  const std::size_t per_direction = roads_.size() / 2;
  for (std::size_t i = 0; i < per_direction; ++i) {
    for (std::size_t k = 0; k < per_direction; ++k) {
      // add_road() alternates the two directions; a block lies half a step beyond each.
      const Eigen::Vector2d u_axis = roads_[0].line.direction();
      const Eigen::Vector2d v_axis = roads_[1].line.direction();
      const Eigen::Vector2d street = 0.5 * (roads_[2 * i].line.a + roads_[2 * i].line.b);
      const Eigen::Vector2d cross_street = 0.5 * (roads_[2 * k + 1].line.a + roads_[2 * k + 1].line.b);
      Area block;
      const Eigen::Vector2d centre = street + cross_street + (u_axis + v_axis) * (0.5 * kBlock_m);
      block.rect = {centre, 0.5 * kBlock_m, 0.5 * kBlock_m, u_axis};
      const auto kind = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
      block.surface = add_framed_surface(ground_cover(kind), block.rect.centre, u_axis, 0.0);
      areas_.push_back(block);
    }
  }
}

// Nobody leaves a round hole in a field of crops, if there is other ground.
std::optional<Eigen::Vector2d> WorldBuilder::find_clearing(Random& random, double radius_m,
                                                           double half_width_m) const {
  std::optional<Eigen::Vector2d> at;
  for (int attempt = 0; attempt < 40; ++attempt) {
    at = plan_.find_free(random, radius_m, half_width_m, 400);
    if (!at) break;
    const bool in_crops = std::any_of(areas_.begin(), areas_.end(), [&](const Area& area) {
      return area.crop_rows && area.rect.distance_m(*at) < radius_m;
    });
    if (!in_crops) break;
  }
  return at;
}

void WorldBuilder::lay_clearings() {
  Random random = stream(5);
  const bool small = config_.hard.has(Hardship::kClearings);
  const bool steep = config_.hard.has(Hardship::kSlopes);
  const int count = scaled(look_.clearings) * (small ? 3 : 1);
  for (int i = 0; i < count; ++i) {
    // The first ones near the middle, where every flight passes.
    const double half_width_m = (i < 2 ? 0.2 : 0.45) * config_.size_m;
    const double radius_m = small ? random.uniform(2.2, 4.0) : random.uniform(4.5, 8.0);
    const double slope = steep ? std::tan(to_radians(random.uniform(6, 14))) : random.uniform(0, 0.05);
    const double downhill = random.uniform(0, 4 * kHalfPi);
    const auto at = find_clearing(random, radius_m, half_width_m);
    if (!at) continue;
    Levelling l;
    l.rect.centre = *at;
    l.margin_m = radius_m;
    l.height_m = smooth_relief_m(*at);
    l.gradient = slope * heading(downhill);
    clearings_.push_back(levellings_.size());
    levellings_.push_back(l);
    plan_.occupy_disc(*at, radius_m);
  }
}

void WorldBuilder::lay_ponds() {
  Random random = stream(6);
  for (int i = 0; i < scaled(look_.ponds); ++i) {
    const double radius_m = random.uniform(4, 9);
    const auto at = plan_.find_free(random, radius_m + 2, 0.42 * config_.size_m, 300);
    if (!at) continue;
    ponds_.push_back({*at, radius_m, smooth_relief_m(*at) - 0.3});
    plan_.occupy_disc(*at, radius_m + 1);
  }
}

void WorldBuilder::lay_buildings() {
  Random random = stream(7);
  const int count = scaled(look_.buildings);
  for (int attempt = 0; attempt < 60 * count && static_cast<int>(building_rects_.size()) < count; ++attempt) {
    GroundRect rect;
    rect.centre = {random.uniform(-half_m(), half_m()), random.uniform(-half_m(), half_m())};
    const bool tall = look_.max_storeys > 3;
    rect.half_u_m = tall ? random.uniform(6, 12) : random.uniform(4.5, 7.5);
    rect.half_v_m = tall ? random.uniform(5, 9) : random.uniform(3.5, 5);
    const double askew_rad = tall ? 0.0 : random.uniform(-0.15, 0.15);
    rect.u_axis = heading(yaw_rad_ + (random.chance(0.5) ? kHalfPi : 0.0) + askew_rad);
    double road_distance_m = 0;
    if (!roads_.empty()) {
      road_distance_m = 1e9;
      for (const Road& road : roads_) {
        road_distance_m = std::min(road_distance_m, (rect.centre - road.line.nearest(rect.centre)).norm());
      }
    }
    // Houses keep to the roads; some stand on their own.
    if (road_distance_m > 28 && !random.chance(0.12)) continue;
    if (!plan_.is_free(rect, 2.5)) continue;
    plan_.occupy_rect(rect, 1.5);
    building_rects_.push_back(rect);
    Levelling l;
    l.rect = rect;
    l.margin_m = 1.2;
    l.height_m = smooth_relief_m(rect.centre);
    levellings_.push_back(l);
  }
}

void WorldBuilder::lay_mounds() {
  Random random = stream(8);
  for (int i = 0; i < scaled(look_.mounds); ++i) {
    const double height_m = look_.mound_height_m * random.uniform(0.7, 1.2);
    const double sigma_m = height_m * random.uniform(1.1, 1.8);
    const auto at = plan_.find_free(random, 1.5 * sigma_m, 0.45 * config_.size_m, 200);
    if (at) mounds_.push_back({*at, sigma_m, height_m});
  }
}

}  // namespace alight::sim
