#include <cstdio>
#include <string>

#include "cli/command_line.hpp"
#include "dataset/dataset_builder.hpp"
#include "infer/benchmark.hpp"
#include "infer/chosen_predictor.hpp"
#include "infer/replay.hpp"

namespace alight {
namespace {

struct Options {
  ConfigOptions config;
  std::string log;
  std::string output;
  std::string checkpoint;
  std::string landing;
  bool lidar_only = false;
  bool benchmark = false;
  ReplayPace pace;
};

void add_options(CLI::App& app, Options& options) {
  add_config_options(app, options.config);
  app.add_option("-l,--log", options.log, "ROS 1 bag to replay");
  app.add_option("-o,--output", options.output, "Folder to make; must not exist");
  app.add_option(
      "--checkpoint", options.checkpoint,
      "Trained network, in place of the configuration's; neither: the one that came with the program");
  app.add_option("--landing", options.landing, "Landing configuration, in place of the section `landing`");
  app.add_flag("--lidar-only", options.lidar_only, "No network: interpolate the LiDAR of max_accumulation_s");
  app.add_flag("--benchmark", options.benchmark,
               "Print median and 95th percentile of every stage, on --log or on synthetic frames");
  app.add_flag("--realtime", options.pace.realtime,
               "Messages come when they came in flight; what the engine is too slow for is lost and counted");
  app.add_option("--repeat", options.pace.rounds, "Replay the log so many times over")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.footer(
      "Examples:\n"
      "  alight-infer --log flight.bag --output out/flight\n"
      "  alight-infer --config configs/infer/default.yaml --checkpoint runs/demo/best.pt --log flight.bag "
      "--output out/flight\n"
      "  alight-infer --log flight.bag --output out/lidar --lidar-only\n"
      "  alight-infer --log flight.bag --realtime\n"
      "  alight-infer --checkpoint runs/demo/best.pt --benchmark\n"
      "  alight-infer --config configs/infer/default.yaml --set engine.history_s=0 --print-config\n"
      "Writes results.jsonl (a line an image), overlay/*.png and method.png to the output folder.");
}

ReplayConfig resolve(const Options& options) {
  auto config = load<ReplayConfig>(options.config);
  if (!options.landing.empty()) config.landing = load_config<LandingConfig>(options.landing);
  if (!options.checkpoint.empty()) config.checkpoint = options.checkpoint;
  if (options.lidar_only) config.checkpoint.reset();
  return config;
}

int run_benchmark(const Options& options, const ReplayConfig& config, const Rig& rig) {
  const auto predictor = make_chosen_predictor(config, rig, options.lidar_only);
  if (!options.log.empty()) {
    std::printf("%s", replay(config, rig, options.log, "", predictor, options.pace).page().c_str());
    return kExitOk;
  }
  constexpr double kHeight_m = 15;
  constexpr double kDuration_s = 5;
  LandingPipeline pipeline(config.engine, config.landing, rig, predictor);
  ReplaySummary summary;
  for (const LogMessage& message : synthetic_hover(rig, kHeight_m, kDuration_s)) {
    for (const FrameReport& frame : pipeline.add(message)) summary.add(frame);
  }
  for (const FrameReport& frame : pipeline.finish()) summary.add(frame);
  std::printf("synthetic hover, %.0f m, %.0f s\n%s", kHeight_m, kDuration_s, summary.page().c_str());
  return kExitOk;
}

int run(const Options& options) {
  const ReplayConfig config = resolve(options);
  if (print_if_asked(options.config, config)) return kExitOk;
  const bool replaying = !options.benchmark;
  if (replaying && options.log.empty()) throw ConfigError("--log is missing: name the ROS 1 bag to replay");
  if (replaying && options.output.empty() && !options.pace.realtime)
    throw ConfigError("--output is missing: name the folder to make");
  const Rig rig = load_rig(find_rig_file(config.rig, options.config.file));
  if (options.benchmark) return run_benchmark(options, config, rig);
  const ReplaySummary summary = replay(config, rig, options.log, options.output,
                                       make_chosen_predictor(config, rig, options.lidar_only), options.pace);
  std::printf("%s", summary.page().c_str());
  if (!options.output.empty()) std::printf("\nresults: %s\n", options.output.c_str());
  return kExitOk;
}

}  // namespace
}  // namespace alight

int main(int argc, char** argv) {
  alight::restart_with_short_spin(argv);
  CLI::App app{"Depth with a verdict and a landing site for every left image of a flight log",
               "alight-infer"};
  alight::Options options;
  alight::add_options(app, options);
  return alight::run_tool(app, argc, argv, [&] { return alight::run(options); });
}
