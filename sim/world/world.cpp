#include "sim/world/world.hpp"

#include <cmath>
#include <utility>

#include "geometry/frames.hpp"
#include "sim/random.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {

Eigen::Vector3d sun_of(const WorldConfig& config) {
  Random random(static_cast<std::uint64_t>(config.seed), 1);
  // Drawn in any case: naming one angle does not change the other.
  const bool dusk = config.hard.has(Hardship::kDusk);
  const double drawn_elevation_deg = dusk ? random.uniform(4, 9) : random.uniform(30, 68);
  const double drawn_azimuth_deg = random.uniform(0, 360);
  const double elevation = to_radians(config.sun_elevation_deg.value_or(drawn_elevation_deg));
  const double azimuth = to_radians(config.sun_azimuth_deg.value_or(drawn_azimuth_deg));
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace

World::World(const WorldConfig& config)
    : parts_(build_world(config)), size_m_(config.size_m), sun_direction_(sun_of(config)) {
  if (config.hard.has(Hardship::kDusk)) daylight_ = 0.2F;
}

World World::from_meshes(std::vector<TriangleMesh> meshes, std::vector<Surface> surfaces, double size_m,
                         const Eigen::Vector3d& sun_direction) {
  World world;
  world.size_m_ = size_m;
  world.sun_direction_ = sun_direction.normalized();
  world.parts_.meshes = std::move(meshes);
  world.parts_.surfaces = std::move(surfaces);
  for (std::size_t i = 0; i < world.parts_.meshes.size(); ++i) {
    world.parts_.placements.emplace_back();
    world.parts_.placements.back().mesh = i;
  }
  return world;
}

std::size_t World::add(TriangleMesh mesh) {
  parts_.meshes.push_back(std::move(mesh));
  return parts_.meshes.size() - 1;
}

double World::ground_height_m(double x_m, double y_m) const {
  return parts_.terrain ? parts_.terrain->height_m(x_m, y_m) : 0.0;
}

}  // namespace alight::sim
