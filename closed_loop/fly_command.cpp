#include "closed_loop/fly_command.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "sim/record/board_recorder.hpp"
#include "sim/record/simulated_log.hpp"
#include "sim/truth/flight_score.hpp"

namespace {

using alight::ConfigError;

struct FlyOptions {
  alight::ConfigOptions config;
  std::filesystem::path output;
  std::vector<std::string> only;
};

struct BoardOptions {
  alight::ConfigOptions config;
  std::filesystem::path output;
};

struct ScoreOptions {
  std::filesystem::path truth;
  std::filesystem::path results;
  std::int64_t require_accepted = 0;
  double require_safe_share = 0;
};

/// Leaves the flights that --flight names.
void select_flights(const std::vector<std::string>& only, std::vector<alight::sim::FlightConfig>& flights) {
  if (only.empty()) return;
  std::vector<alight::sim::FlightConfig> selected;
  for (const std::string& name : only) {
    const std::size_t before = selected.size();
    for (const auto& flight : flights) {
      if (flight.name == name) selected.push_back(flight);
    }
    if (selected.size() == before)
      throw ConfigError("--flight " + name + ": the configuration has no such flight");
  }
  flights = selected;
}

int fly(const FlyOptions& options) {
  auto config = alight::load<alight::sim::SimConfig>(options.config);
  if (alight::print_if_asked(options.config, config)) return alight::kExitOk;
  if (options.output.empty()) throw ConfigError("--output: is missing; name the folder for the flights");
  select_flights(options.only, config.flights);
  const alight::sim::FlightRecorder recorder(config, options.output);
  recorder.refuse_existing();
  for (const auto& flight : config.flights) {
    const alight::sim::RecordedFlight recorded = recorder.record(flight);
    std::printf("%s  %lld stereo frames  %lld lidar packets  %lld messages  %.1f MB\n",
                (options.output / (flight.name + ".bag")).c_str(), static_cast<long long>(recorded.frames),
                static_cast<long long>(recorded.lidar_packets), static_cast<long long>(recorded.messages),
                static_cast<double>(recorded.bag_bytes) * 1e-6);
    std::fflush(stdout);
  }
  return alight::kExitOk;
}

int record_boards(const BoardOptions& options) {
  const auto config = alight::load<alight::sim::BoardSceneConfig>(options.config);
  if (alight::print_if_asked(options.config, config)) return alight::kExitOk;
  if (options.output.empty()) throw ConfigError("--output: is missing; name the folder for the recordings");
  for (const auto& bag : alight::sim::record_boards(config, options.output)) std::printf("%s\n", bag.c_str());
  return alight::kExitOk;
}

int score(const ScoreOptions& options) {
  const alight::sim::FlightScore result = alight::sim::score_flight(options.truth, options.results);
  std::fputs(alight::sim::format_score(result).c_str(), stdout);
  const double share = result.all.accepted > 0
                           ? static_cast<double>(result.all.safe) / static_cast<double>(result.all.accepted)
                           : 0.0;
  const bool enough = result.all.accepted >= options.require_accepted;
  const bool safe = options.require_safe_share <= 0 || share >= options.require_safe_share;
  if (!enough)
    spdlog::error("fewer accepted sites than required: {} < {}", result.all.accepted,
                  options.require_accepted);
  if (!safe) spdlog::error("too few on safe ground: share {:.3f} < {}", share, options.require_safe_share);
  return enough && safe ? alight::kExitOk : alight::kExitFailure;
}

void add_score_options(CLI::App& app, ScoreOptions& options) {
  app.add_option("--truth", options.truth, "Folder <flight>.truth")->required();
  app.add_option("--results", options.results, "results.jsonl of alight-infer on that flight")->required();
  app.add_option("--require-accepted", options.require_accepted, "Exit with 1 if fewer sites were accepted")
      ->capture_default_str();
  app.add_option("--require-safe-share", options.require_safe_share,
                 "Exit with 1 if a smaller share (0..1) of them lies on truly safe ground")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

}  // namespace

namespace alight::closed_loop {

Command add_fly_command(CLI::App& app) {
  auto options = std::make_shared<FlyOptions>();
  add_config_options(app, options->config);
  app.add_option("-o,--output", options->output, "Folder for <flight>.bag and <flight>.truth/");
  app.add_option("--flight", options->only, "Fly only this flight of the configuration (repeatable)")
      ->allow_extra_args(false);
  return {&app, [options] { return fly(*options); }};
}

Command add_board_command(CLI::App& app) {
  auto options = std::make_shared<BoardOptions>();
  CLI::App* command =
      app.add_subcommand("board", "Records a chessboard in front of the rig, for alight-calibrate");
  add_config_options(*command, options->config);
  command->add_option("-o,--output", options->output, "Folder for board_00.bag and so on; must not exist");
  return {command, [options] { return record_boards(*options); }};
}

Command add_score_command(CLI::App& app) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      app.add_subcommand("score", "Holds the landing sites of alight-infer against the truth");
  add_score_options(*command, *options);
  return {command, [options] { return score(*options); }};
}

}  // namespace alight::closed_loop
