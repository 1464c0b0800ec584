#include <cstdio>
#include <string>

#include "foundation/command_line.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "infer/autopilot/autopilot_link.hpp"
#include "infer/network/chosen_predictor.hpp"
#include "infer/network/network_benchmark.hpp"
#include "infer/recorder/explanation.hpp"
#include "infer/recorder/flight_recorder.hpp"
#include "infer/replay/replay.hpp"
#include "infer/replay/stage_benchmark.hpp"
#include "infer/web/ground_station.hpp"

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
  bool benchmark_network = false;
  int benchmark_runs = 50;
  std::optional<std::string> dump;
  bool json = false;
  ReplayPace pace;
  std::optional<std::string> web;
  std::optional<std::string> web_token;
  std::optional<std::string> autopilot;
  std::optional<std::string> record;
  std::optional<std::string> explain;
  bool automatic = false;
};

void add_benchmark_options(CLI::App& app, Options& options) {
  app.add_flag("--benchmark", options.benchmark,
               "Print median and 95th percentile of every stage, on --log or on synthetic frames");
  auto* network = app.add_flag("--benchmark-network", options.benchmark_network,
                               "Time the network alone, against what convolutions reach here");
  app.add_option("--benchmark-runs", options.benchmark_runs,
                 "Passes that --benchmark-network times of each kind")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000))
      ->needs(network);
  app.add_option("--dump", options.dump,
                 "Folder for the inputs and the result that --benchmark-network computed")
      ->needs(network);
  app.add_flag("--json", options.json, "Print --benchmark-network's figures as a line of JSON")
      ->needs(network);
}

/// What needs the log's own pace.
void add_flight_options(CLI::App& app, Options& options) {
  auto* realtime = app.add_flag(
      "--realtime", options.pace.realtime,
      "Messages come when they came in flight; what the engine is too slow for is lost and counted");
  auto* web = app.add_option("--web", options.web,
                             "Serve the ground-station page there, such as :8080 for this computer alone")
                  ->needs(realtime);
  app.add_option(
         "--web-token", options.web_token,
         "Who has it may switch between automatic and manual; without: a random one, said at the start")
      ->needs(web);
  app.add_option(
         "--autopilot", options.autopilot,
         "Send landing sites there by MAVLink, such as udp:127.0.0.1:14550; in place of the configuration's")
      ->needs(realtime);
  app.add_flag("--automatic", options.automatic,
               "Begin in automatic mode; else a person flies, and no landing site is sent")
      ->needs(realtime);
}

void add_recorder_options(CLI::App& app, Options& options) {
  auto* record =
      app.add_option("--record", options.record,
                     "Keep a crash-safe record of the flight in this folder; with --explain: read it");
  app.add_option("--explain", options.explain,
                 "Say why a site was chosen or not at this time, in seconds of the record or nanoseconds, "
                 "and draw it to "
                 "--output (PNG)")
      ->needs(record);
}

void add_options(CLI::App& app, Options& options) {
  add_config_options(app, options.config);
  app.add_option("-l,--log", options.log, "ROS 1 bag to replay");
  app.add_option("-o,--output", options.output, "Folder to make; must not exist");
  app.add_option(
      "--checkpoint", options.checkpoint,
      "Trained network, in place of the configuration's; neither: the one that came with the program");
  app.add_option("--landing", options.landing, "Landing configuration, in place of the section `landing`");
  app.add_flag("--lidar-only", options.lidar_only, "No network: interpolate the LiDAR of max_accumulation_s");
  add_benchmark_options(app, options);
  add_flight_options(app, options);
  add_recorder_options(app, options);
  app.add_option("--repeat", options.pace.rounds, "Replay the log so many times over")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.footer(
      "Examples:\n"
      "  alight-infer --log flight.bag --output out/flight\n"
      "  alight-infer --config configs/infer/default.yaml --checkpoint runs/demo/best.pt --log flight.bag "
      "--output out/flight\n"
      "  alight-infer --log flight.bag --output out/lidar --lidar-only\n"
      "  alight-infer --log flight.bag --realtime --web :8080 --record out/record\n"
      "  alight-infer --record out/record --explain 12.5 --output why.png\n"
      "  alight-infer --checkpoint runs/demo/best.pt --benchmark\n"
      "  alight-infer --config configs/infer/default.yaml --set engine.history_s=0 --print-config\n"
      "Writes results.jsonl (a line an image), overlay/*.png and method.png to the output folder.");
}

ReplayConfig resolve(const Options& options) {
  auto config = load<ReplayConfig>(options.config);
  if (!options.landing.empty()) config.landing = load_config<LandingConfig>(input_file(options.landing));
  if (!options.checkpoint.empty()) config.checkpoint = options.checkpoint;
  if (options.autopilot) config.autopilot.connection = options.autopilot;
  if (options.lidar_only) config.checkpoint.reset();
  return config;
}

int run_network_benchmark(const Options& options, const ReplayConfig& config, const Rig& rig) {
  const RectifiedRig camera = engine_rig(config.engine, rig);
  const NetworkBenchmark result =
      benchmark_network(chosen_network(config), camera.intrinsics, camera.baseline_m, config.network,
                        options.benchmark_runs, options.dump);
  std::fputs((options.json ? result.json() : result.table()).c_str(), stdout);
  return kExitOk;
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

ReplaySummary run_replay(const Options& options, const ReplayConfig& config, const Rig& rig) {
  const auto predictor = make_chosen_predictor(config, rig, options.lidar_only);
  if (!options.pace.realtime)
    return replay(config, rig, options.log, options.output, predictor, options.pace);
  const DepthEngine camera(config.engine, rig, nullptr);
  ModeSwitch mode(options.automatic ? FlightMode::kAutomatic : FlightMode::kManual);
  AutopilotLink autopilot(config.autopilot, camera.rig(), mode);
  std::vector<FrameSink*> sinks{&autopilot};
  std::optional<FlightRecorder> recorder;
  if (options.record) {
    const cv::Rect crop = camera.crop();
    recorder.emplace(RecorderConfig{}, *options.record,
                     RecordedSettings{crop.x, crop.y, config.engine, config.landing});
    sinks.push_back(&*recorder);
  }
  std::optional<GroundStation> station;
  if (options.web) {
    GroundStationConfig web;
    web.address = *options.web;
    web.token = options.web_token;
    station.emplace(web, mode, camera.crop(), config.landing.tracker.confirm_frames);
    sinks.push_back(&*station);
  }
  return replay(config, rig, options.log, options.output, predictor, options.pace, sinks,
                [&](const EngineRunner* runner) {
                  if (!station) return;
                  if (runner == nullptr) return station->set_statistics({});
                  station->set_statistics([runner] { return runner->statistics(); });
                });
}

int run(const Options& options) {
  if (options.explain) {
    return run_explain(*options.record, *options.explain,
                       options.output.empty() ? "explanation.png" : options.output);
  }
  const ReplayConfig config = resolve(options);
  if (print_if_asked(options.config, config)) return kExitOk;
  const bool replaying = !options.benchmark && !options.benchmark_network;
  if (replaying && options.log.empty()) throw ConfigError("--log is missing: name the ROS 1 bag to replay");
  if (replaying && options.output.empty() && !options.pace.realtime)
    throw ConfigError("--output is missing: name the folder to make");
  const Rig rig = load_rig(find_rig_file(config.rig, options.config.file));
  if (options.benchmark_network) return run_network_benchmark(options, config, rig);
  if (options.benchmark) return run_benchmark(options, config, rig);
  const ReplaySummary summary = run_replay(options, config, rig);
  std::printf("%s", summary.page().c_str());
  if (!options.output.empty()) std::printf("\nresults: %s\n", options.output.c_str());
  return kExitOk;
}

}  // namespace
}  // namespace alight

int main(int argc, char** argv) {
  alight::restart_with_short_spin(argv);
  alight::keep_freed_memory();
  CLI::App app{"Depth with a verdict and a landing site for every left image of a flight log",
               "alight-infer"};
  alight::Options options;
  alight::add_options(app, options);
  return alight::run_tool(app, argc, argv, [&] { return alight::run(options); });
}
