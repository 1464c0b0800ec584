#include "sim/world/world_builder.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/parallel_rows.hpp"
#include "sim/objects/shapes.hpp"

namespace alight::sim {
WorldBuilder::WorldBuilder(const WorldConfig& config)
    : config_(config), look_(parameters(config.look)), plan_(config.size_m) {
  yaw_rad_ = stream(2).uniform(0, kTwoPi);
  ground_ = add_surface(ground_cover(look_.ground));
  ground_alt_ = add_surface(ground_cover(look_.ground_alt));
  patches_ = add_surface(ground_cover(look_.patches));
  shoulder_ = add_surface(look_.road_net == RoadNet::kGrid ? Material::kPaving : Material::kGravel);
  mud_ = add_surface(Material::kSoil, {0.6F, 0.6F, 0.6F});
}

Random WorldBuilder::stream(std::uint64_t step) const {
  return Random(static_cast<std::uint64_t>(config_.seed) * 64 + static_cast<std::uint64_t>(config_.look),
                100 + step);
}

int WorldBuilder::scaled(int count) const {
  const double share = config_.size_m * config_.size_m / (160.0 * 160.0);
  return count == 0 ? 0 : std::max(1, static_cast<int>(std::lround(count * share)));
}

std::uint16_t WorldBuilder::add_surface(Material material, const Eigen::Vector3f& tint) {
  Surface surface;
  surface.material = material;
  surface.tint_rgb = tint;
  surface.seed =
      mix_bits(static_cast<std::uint32_t>(surfaces.size()), static_cast<std::uint32_t>(config_.seed));
  surfaces.push_back(surface);
  return static_cast<std::uint16_t>(surfaces.size() - 1);
}

std::uint16_t WorldBuilder::add_framed_surface(Material material, const Eigen::Vector2d& origin,
                                               const Eigen::Vector2d& u_axis, double width_m) {
  const std::uint16_t index = add_surface(material);
  const Eigen::Vector2f u = u_axis.cast<float>();
  surfaces[index].framed = true;
  surfaces[index].origin = {static_cast<float>(origin.x()), static_cast<float>(origin.y()), 0};
  surfaces[index].u_axis = {u.x(), u.y(), 0};
  surfaces[index].v_axis = {-u.y(), u.x(), 0};
  surfaces[index].width_m = static_cast<float>(width_m);
  return index;
}

void WorldBuilder::build() {
  lay_roads();
  lay_areas();
  lay_clearings();
  lay_ponds();
  lay_buildings();
  lay_mounds();
  shape_ground();
  paint_ground();
  add_mesh(terrain->mesh());
  placements.emplace_back();
  raise_buildings();
  add_water();
  add_kerbs();
  string_power_line();
  set_lamps_and_bales();
  park_cars();
  plant_trees();
  scatter_boulders();
  plant_small();
  grow_crops();
  add_hardships();
  add_movers();
  placements.push_back({add_mesh(std::move(fixed_)), Eigen::Affine3f::Identity(), Eigen::Vector3f::Ones()});
}

double WorldBuilder::smooth_relief_m(const Eigen::Vector2d& p) const {
  const ReliefOctave& first = look_.relief.front();
  const auto seed = mix_bits(static_cast<std::uint32_t>(config_.seed), 77U);
  // Two turned copies: one lattice alone shows its axes as ridges.
  return first.amplitude_m * 0.7 *
         (value_noise(p.x() / first.wavelength_m, p.y() / first.wavelength_m, seed) +
          value_noise((0.6 * p.x() + 0.8 * p.y()) / first.wavelength_m + 7.3,
                      (-0.8 * p.x() + 0.6 * p.y()) / first.wavelength_m, seed + 1));
}

double WorldBuilder::relief_m(const Eigen::Vector2d& p) const {
  double height_m = smooth_relief_m(p);
  auto seed = mix_bits(static_cast<std::uint32_t>(config_.seed), 78U);
  for (std::size_t i = 1; i < look_.relief.size(); ++i) {
    const ReliefOctave& octave = look_.relief[i];
    height_m +=
        octave.amplitude_m * value_noise(p.x() / octave.wavelength_m, p.y() / octave.wavelength_m, seed++);
  }
  for (const Mound& mound : mounds_) {
    const double distance = (p - mound.centre).norm() / mound.sigma_m;
    if (distance < 4) height_m += mound.height_m * std::exp(-0.5 * distance * distance);
  }
  return height_m;
}

namespace {
double smooth_step(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}
}  // namespace

double WorldBuilder::shaped_height_m(const Eigen::Vector2d& p) const {
  double height_m = relief_m(p);
  const auto level = [&](double distance_m, double falloff_m, double target_m) {
    const double weight = 1 - smooth_step(distance_m / falloff_m);
    height_m += weight * (target_m - height_m);
  };
  for (const Road& road : roads_) {
    const Eigen::Vector2d foot = road.line.nearest(p);
    const double distance_m = (p - foot).norm() - 0.5 * road.width_m - 1.0;
    if (distance_m < 5) level(distance_m, 5, smooth_relief_m(foot));
  }
  for (const Levelling& l : levellings_) {
    const Eigen::Vector2d d = p - l.rect.centre;
    if (d.cwiseAbs().maxCoeff() > l.rect.half_u_m + l.rect.half_v_m + l.margin_m + l.falloff_m) continue;
    level(l.rect.distance_m(p) - l.margin_m, l.falloff_m, l.height_m + l.gradient.dot(d));
  }
  for (const Pond& pond : ponds_) {
    constexpr double kDepth_m = 1.3;
    constexpr double kBank_m = 0.25;
    const double share = (p - pond.centre).norm() / pond.radius_m;
    if (share > 3) continue;
    level((share - 1) * pond.radius_m, 4, pond.level_m + kBank_m);
    if (share < 1) height_m = pond.level_m + kBank_m - kDepth_m * (1 - share * share);
  }
  return height_m;
}

void WorldBuilder::shape_ground() {
  terrain.emplace(config_.size_m, ground_);
  parallel_rows(0, terrain->grid_size(), [&](int row) {
    for (int column = 0; column < terrain->grid_size(); ++column) {
      const Eigen::Vector2d p(terrain->axis_m(column), terrain->axis_m(row));
      terrain->vertex_height_m(row, column) = static_cast<float>(shaped_height_m(p));
    }
  });
  // The world's origin lies on the ground.
  const auto lift_m = static_cast<float>(terrain->height_m(0.0, 0.0));
  for (int row = 0; row < terrain->grid_size(); ++row) {
    for (int column = 0; column < terrain->grid_size(); ++column)
      terrain->vertex_height_m(row, column) -= lift_m;
  }
  for (Pond& pond : ponds_) pond.level_m -= static_cast<double>(lift_m);
}

std::uint16_t WorldBuilder::natural_cover(const Eigen::Vector2d& p) const {
  const auto seed = mix_bits(static_cast<std::uint32_t>(config_.seed), 79U);
  const auto blotches = [&](double wavelength_m, std::uint32_t salt) {
    return value_noise(p.x() / wavelength_m, p.y() / wavelength_m, seed + salt) +
           0.5 * value_noise(p.x() / wavelength_m * 3.7, p.y() / wavelength_m * 3.7, seed + salt + 1) +
           0.3 * value_noise(p.x() / wavelength_m * 13.1, p.y() / wavelength_m * 13.1, seed + salt + 2);
  };
  if (blotches(9, 0) > 0.75) return patches_;
  return blotches(15, 10) > 0.25 ? ground_alt_ : ground_;
}

std::uint16_t WorldBuilder::cover_at(const Eigen::Vector2d& p, const std::vector<const Area*>& areas) const {
  double nearest_shoulder_m = 1e9;
  for (const Road& road : roads_) {
    const double distance_m = (p - road.line.nearest(p)).norm() - 0.5 * road.width_m;
    if (distance_m < 0) return road.surface;
    nearest_shoulder_m = std::min(nearest_shoulder_m, distance_m);
  }
  const double shoulder_m =
      look_.road_net == RoadNet::kGrid ? 2.5 : (look_.road_net == RoadNet::kCross ? 0.5 : 0.0);
  if (nearest_shoulder_m < shoulder_m) return shoulder_;
  for (const Pond& pond : ponds_) {
    if ((p - pond.centre).norm() < pond.radius_m + 0.5) return mud_;
  }
  for (const GroundRect& rect : building_rects_) {
    if ((p - rect.centre).cwiseAbs().maxCoeff() < rect.half_u_m + rect.half_v_m + 1 &&
        rect.distance_m(p) < 0.8) {
      return shoulder_;
    }
  }
  for (const Area* area : areas) {
    if (area->rect.distance_m(p) == 0) return area->surface;
  }
  return natural_cover(p);
}

void WorldBuilder::paint_ground() {
  parallel_rows(0, terrain->cover_size(), [&](int row) {
    std::vector<const Area*> areas;
    for (const Area& area : areas_) {
      const double reach_m = std::hypot(area.rect.half_u_m, area.rect.half_v_m);
      if (std::abs(terrain->cover_axis_m(row) - area.rect.centre.y()) <= reach_m) areas.push_back(&area);
    }
    for (int column = 0; column < terrain->cover_size(); ++column) {
      terrain->cover_cell(row, column) =
          cover_at({terrain->cover_axis_m(column), terrain->cover_axis_m(row)}, areas);
    }
  });
  terrain->find_cover_borders();
}

std::size_t WorldBuilder::add_mesh(TriangleMesh mesh) {
  meshes.push_back(std::move(mesh));
  return meshes.size() - 1;
}

Eigen::Vector3f WorldBuilder::on_ground(const Eigen::Vector2d& p) const {
  return Eigen::Vector3d(p.x(), p.y(), terrain->height_m(p.x(), p.y())).cast<float>();
}

void WorldBuilder::put(std::size_t mesh, const Eigen::Vector2d& at, double sink_m, double yaw_rad,
                       double scale, const Eigen::Vector3f& tint) {
  const Eigen::Vector3f position = on_ground(at) - Eigen::Vector3f(0, 0, static_cast<float>(sink_m));
  placements.push_back({mesh, place(position, static_cast<float>(yaw_rad), static_cast<float>(scale)), tint});
}

void WorldBuilder::scatter(Random& random, const std::vector<std::size_t>& kinds, int count, double min_scale,
                           double max_scale, double clear_radius, bool keep, double sink) {
  constexpr int kAttempts = 12;
  for (int i = 0; i < count; ++i) {
    // Small ones are many, big ones few.
    const double scale = min_scale + (max_scale - min_scale) * random.uniform() * random.uniform();
    const auto at = plan_.find_free(random, clear_radius * scale, half_m(), kAttempts);
    const auto kind = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
    const double yaw_rad = random.uniform(0, kTwoPi);
    const float shade = random.uniformf(0.75, 1.3);
    const Eigen::Vector3f tint(shade * random.uniformf(0.9, 1.15), shade, shade * random.uniformf(0.85, 1.1));
    if (!at) continue;
    put(kind, *at, sink * scale, yaw_rad, scale, tint);
    if (keep) plan_.occupy_disc(*at, clear_radius * scale);
  }
}

}  // namespace alight::sim
