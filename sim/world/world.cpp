#include "sim/world/world.hpp"

#include <cmath>
#include <utility>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "sim/random.hpp"
#include "sim/world/world_builder.hpp"

namespace alight::sim {
namespace {

const std::vector<std::pair<std::string, Look>> kLookNames = {{"village", Look::kVillage},
                                                              {"forest", Look::kForest},
                                                              {"farmland", Look::kFarmland},
                                                              {"rocky", Look::kRocky},
                                                              {"urban", Look::kUrban}};

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

void bind(Binder& b, VisitorConfig& c) {
  b.choice("kind", c.kind,
           {{"none", VisitorKind::kNone}, {"car", VisitorKind::kCar}, {"person", VisitorKind::kPerson}},
           "who comes");
  b.field("from_x_m", c.from_x_m, "where it stands first, east of the world's middle");
  b.field("from_y_m", c.from_y_m, "north of it");
  b.field("to_x_m", c.to_x_m, "where it goes, straight, and stays");
  b.field("to_y_m", c.to_y_m, "likewise");
  b.field("begin_s", c.begin_s, "when it sets out, from the start of the flight");
  b.field("speed_mps", c.speed_mps, "how fast it goes", between(0.1, 50));
  const bool stands = c.from_x_m == c.to_x_m && c.from_y_m == c.to_y_m;
  b.check("to_x_m", c.kind == VisitorKind::kNone || !stands,
          "must be another place than where it stands first");
}

void bind(Binder& b, WorldConfig& c) {
  b.choice("look", c.look, kLookNames, "kind of place");
  b.field("seed", c.seed, "of everything random in the world", at_least(0));
  b.field("size_m", c.size_m, "side of the square built in detail", between(60, 400));
  b.field("sun_elevation_deg", c.sun_elevation_deg, "none: drawn from the seed", between(5, 90));
  b.field("sun_azimuth_deg", c.sun_azimuth_deg, "counter-clockwise from east; none: drawn from the seed",
          between(-360, 360));
  b.field("hard", c.hard.names, "what makes the place harder: any of " + hardship_names());
  b.check("hard", c.hard.unknown().empty(), "\"" + c.hard.unknown() + "\" is none of " + hardship_names());
  b.section("visitor", c.visitor, "a car or a person that comes to a place");
}

std::string to_string(Look look) {
  for (const auto& [name, value] : kLookNames) {
    if (value == look) return name;
  }
  return "unknown";
}

std::vector<Look> all_looks() {
  std::vector<Look> looks;
  for (const auto& [name, look] : kLookNames) looks.push_back(look);
  return looks;
}

World::World(const WorldConfig& config) : size_m_(config.size_m), sun_direction_(sun_of(config)) {
  if (config.hard.has(Hardship::kDusk)) daylight_ = 0.2F;
  WorldBuilder builder(config);
  builder.build();
  meshes_ = std::move(builder.meshes);
  placements_ = std::move(builder.placements);
  surfaces_ = std::move(builder.surfaces);
  movers_ = std::move(builder.movers);
  terrain_ = std::move(builder.terrain);
}

World World::from_meshes(std::vector<TriangleMesh> meshes, std::vector<Surface> surfaces, double size_m,
                         const Eigen::Vector3d& sun_direction) {
  World world;
  world.size_m_ = size_m;
  world.sun_direction_ = sun_direction.normalized();
  world.meshes_ = std::move(meshes);
  world.surfaces_ = std::move(surfaces);
  for (std::size_t i = 0; i < world.meshes_.size(); ++i) {
    world.placements_.emplace_back();
    world.placements_.back().mesh = i;
  }
  return world;
}

std::size_t World::add(TriangleMesh mesh) {
  meshes_.push_back(std::move(mesh));
  return meshes_.size() - 1;
}

double World::ground_height_m(double x_m, double y_m) const {
  return terrain_ ? terrain_->height_m(x_m, y_m) : 0.0;
}

}  // namespace alight::sim
