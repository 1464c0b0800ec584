#include "sim/record/sim_config.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "foundation/config_reader.hpp"

namespace alight::sim {
namespace {

bool is_file_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

bool names_differ(const std::vector<FlightConfig>& flights) {
  std::set<std::string> names;
  for (const FlightConfig& flight : flights) names.insert(flight.name);
  return names.size() == flights.size();
}

}  // namespace

void bind(Binder& b, FlightConfig& c) {
  b.required("name", c.name, "the log is <name>.bag, its truth <name>.truth/");
  b.field("seed", c.seed, "of the path's turns and of all noise", at_least(0));
  b.section("world", c.world, "the place");
  b.section("plan", c.plan, "how the vehicle flies");
  b.check("name", is_file_name(c.name), "may hold letters, digits, _ - and . only, and not begin with .");
}

void bind(Binder& b, RecorderConfig& c) {
  b.choice("compression", c.compression, {{"none", BagCompression::kNone}, {"lz4", BagCompression::kLz4}},
           "of the bag's chunks");
  b.field("truth", c.truth, "write depth and safe ground of every left image");
  b.field("truth_png_level", c.truth_png_level, "zlib level of these PNG files", between(0, 9));
  b.field("trajectory_rate_hz", c.trajectory_rate_hz, "rows a second of trajectory.csv", between(1, 10000));
  b.field("clearance_m", c.clearance_m, "a path that comes nearer to an obstacle below is refused",
          at_least(0));
  b.field("edge_margin_m", c.edge_margin_m, "a path that comes nearer to the edge of its world is refused",
          at_least(0));
  b.field("threads", c.threads, "frames made at the same time; the files do not depend on it",
          between(1, 256));
}

void bind(Binder& b, SimConfig& c) {
  b.field("rig", c.rig, "rig file, relative to the working directory");
  b.section("sensors", c.sensors, "what the sensors measure and when");
  b.section("renderer", c.renderer, "how images are made");
  b.section("surface_truth", c.surface_truth, "what counts as safe ground");
  b.section("recorder", c.recorder, "how flights are written");
  b.list("flights", c.flights, "the flights to record, one after the other");
  b.check("flights", !c.flights.empty(), "needs at least one flight");
  b.check("flights", names_differ(c.flights), "two flights have the same name");
}

}  // namespace alight::sim
