#include "closed_loop/land_command.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "closed_loop/landing/land_config.hpp"
#include "closed_loop/landing/landing_flight.hpp"
#include "closed_loop/landing/landing_pictures.hpp"
#include "closed_loop/landing/network_choice.hpp"
#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "infer/mission/mission_table.hpp"
#include "pictures/picture_file.hpp"

namespace alight::closed_loop {
namespace {

namespace fs = std::filesystem;

struct LandOptions {
  ConfigOptions config;
  int world = 1;
  std::string look;
  fs::path output;
  bool lidar_only = false;
  bool no_bag = false;
  bool print_states = false;
  std::string fault;
  double fault_at_s = 10;
  std::optional<double> fault_lasts_s;
};

PlannedFault planned_fault(const LandOptions& options) {
  if (options.fault.empty()) return {};
  if (const sim::Fault* fault = sim::find_fault(options.fault))
    return {fault, options.fault_at_s, options.fault_lasts_s};
  std::string known;
  for (const sim::Fault& fault : sim::all_faults()) known += "\n  " + fault.name;
  throw ConfigError("--fault " + options.fault + ": no such fault; there are" + known);
}

LandConfig resolve(const LandOptions& options) {
  auto config = load<LandConfig>(options.config);
  config.world.seed = options.world;
  if (options.look.empty()) return config;
  for (const sim::Look look : sim::all_looks()) {
    if (sim::to_string(look) != options.look) continue;
    config.world.look = look;
    return config;
  }
  std::string known;
  for (const sim::Look look : sim::all_looks()) known += " " + sim::to_string(look);
  throw ConfigError("--look " + options.look + ": no such look; there are" + known);
}

void write_track(const fs::path& path, const FlownLanding& flown) {
  std::string text = "t_s,x_m,y_m,z_m,state\n";
  for (const TrackPoint& point : flown.track) {
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{}\n", point.t_s, point.p_world.x(), point.p_world.y(),
                        point.p_world.z(), name(point.state));
  }
  write_file_atomically(path, text);
}

int land(const LandOptions& options) {
  if (options.print_states) {
    std::fputs(mission_tables_markdown().c_str(), stdout);
    return kExitOk;
  }
  const LandConfig config = resolve(options);
  if (print_if_asked(options.config, config)) return kExitOk;
  const PlannedFault fault = planned_fault(options);
  std::optional<OutputFolder> folder;
  std::optional<sim::BagWriter> bag;
  if (!options.output.empty()) {
    folder.emplace(options.output);
    if (!options.no_bag) bag.emplace(folder->partial() / "log.bag", sim::BagCompression::kNone);
  }
  LandingFlight flight(config, config.world.seed, choose_network(config, options.lidar_only), fault);
  const FlownLanding flown = flight.fly(bag ? &*bag : nullptr);
  for (const auto& event : flown.result.events) {
    std::printf("%7.2f s  %-14s %s\n", static_cast<double>(event.t_ns) * 1e-9 - flown.clock_start_s,
                name(event.to), event.reason.c_str());
  }
  std::printf("%s\n", describe(flown.result, config.flight.wanted_radius_m).c_str());
  if (!folder) return kExitOk;
  if (bag) bag->commit();
  write_file_atomically(folder->partial() / "result.json", to_json(flown.result) + "\n");
  write_file_atomically(folder->partial() / "config.yaml", print_config(config));
  write_track(folder->partial() / "trajectory.csv", flown);
  write_picture(folder->partial() / "trajectory.png", trajectory_picture(flown, flight.surface_truth()));
  write_picture(folder->partial() / "top.png",
                top_picture(flown, flight.surface_truth(), config.flight.body_radius_m));
  folder->commit();
  return kExitOk;
}

}  // namespace

Command add_land_command(CLI::App& app) {
  auto options = std::make_shared<LandOptions>();
  CLI::App* command =
      app.add_subcommand("land", "Lands once, the onboard program in the loop, and says on what");
  add_config_options(*command, options->config);
  command->add_option("--world", options->world, "Seed of the place, the wind and all noise")
      ->capture_default_str();
  command->add_option("--look", options->look, "Kind of place, in place of the configuration's");
  command->add_option(
      "-o,--output", options->output,
      "Folder to make: log.bag, trajectory.png, top.png, trajectory.csv, result.json, config.yaml");
  command->add_flag("--lidar-only", options->lidar_only, "No network");
  command->add_flag("--no-bag", options->no_bag, "Do not keep the messages");
  command->add_option("--fault", options->fault, "A sensor failure by its name, such as \"LiDAR lost\"");
  command->add_option("--fault-at", options->fault_at_s, "Seconds after the begin at which it strikes")
      ->capture_default_str();
  command->add_option("--fault-duration", options->fault_lasts_s,
                      "Seconds after which it passes; without: it stays");
  command->add_flag("--print-states", options->print_states, "Print the tables of docs/mission.md");
  command->footer(
      "Examples:\n"
      "  alight-sim land --world 7 --config configs/landing/default.yaml --output out/landing\n"
      "  alight-sim land --world 7 --look urban --lidar-only --fault \"position lost\" --fault-at 12");
  return {command, [options] { return land(*options); }};
}

}  // namespace alight::closed_loop
