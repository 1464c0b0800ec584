#include "sim/spec/world_config.hpp"

#include <utility>

#include "foundation/config_reader.hpp"

namespace alight::sim {
namespace {

const std::vector<std::pair<std::string, Look>> kLookNames = {{"village", Look::kVillage},
                                                              {"forest", Look::kForest},
                                                              {"farmland", Look::kFarmland},
                                                              {"rocky", Look::kRocky},
                                                              {"urban", Look::kUrban}};

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

}  // namespace alight::sim
