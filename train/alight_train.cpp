#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

#include <spdlog/spdlog.h>

#include "dataset/store/sample_store.hpp"
#include "foundation/command_line.hpp"
#include "models/network_summary.hpp"
#include "train/benchmark.hpp"
#include "train/distributed/process_group.hpp"
#include "train/logging/provenance.hpp"
#include "train/logging/run_folder.hpp"
#include "train/plot_command.hpp"
#include "train/train_config.hpp"
#include "train/trainer.hpp"

namespace {

using namespace alight;

constexpr const char* kExamples =
    "Examples:\n"
    "  alight-train --config configs/train/demo.yaml --output runs/demo\n"
    "  alight-train --config configs/train/demo.yaml --output runs/longer --set train.epochs=30\n"
    "  alight-train --resume runs/demo\n"
    "  scripts/cluster/launch.sh 4 --config configs/train/demo.yaml --output runs/demo    (four processes)\n"
    "  alight-train --config configs/train/paper.yaml --print-model\n"
    "  alight-train --config configs/train/paper.yaml --print-config\n"
    "  alight-train --config configs/train/default.yaml --benchmark\n"
    "  alight-train plot runs/demo runs/longer --output curves.png\n";

struct Options {
  ConfigOptions config;
  std::string output;
  std::string resume;
  bool print_model = false;
  int model_size_px = 352;
  bool benchmark = false;
  int benchmark_steps = 10;
  bool json = false;
};

void add_options(CLI::App& app, Options& options) {
  add_config_options(app, options.config);
  app.add_option("-o,--output", options.output, "Folder of the run; must not exist yet");
  app.add_option("--resume", options.resume, "Go on with the run in this folder, from its last.pt");
  app.add_flag("--print-model", options.print_model,
               "Print the network's layers, parameters and GFLOP, then exit");
  app.add_option("--model-size", options.model_size_px, "Image side for --print-model, pixels")
      ->capture_default_str()
      ->check(CLI::Range(32, 4096));
  auto* benchmark = app.add_flag("--benchmark", options.benchmark,
                                 "Time training steps with and without loading, print speed, memory and the "
                                 "share of this machine's convolution speed, then exit; nothing is kept");
  app.add_option("--benchmark-steps", options.benchmark_steps, "Steps that --benchmark times of each kind")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000))
      ->needs(benchmark);
  app.add_flag("--json", options.json, "Print --benchmark's figures as a line of JSON")->needs(benchmark);
  app.footer(kExamples);
}

/// What judges the run: the held-out blocks of its flights, or, where none is held out, the unknown flights.
std::optional<DatasetSource> validation_source(const TrainConfig& config) {
  for (const SplitPart part : {SplitPart::kHeldOut, SplitPart::kUnknown}) {
    DatasetSource source(config.dataset, config.split, part, /*with_dense=*/true);
    if (source.size() > 0) return source;
  }
  return std::nullopt;
}

void print_result(const ValidationReport& report) {
  const ValidationRow& network = report.at(0.3);
  std::printf("%s", report.table().c_str());
  std::printf("validation %s: network %.1f mm, altitude plane %.1f mm, fill without network %.1f mm\n",
              network.name.c_str(), network.ground_truth.rmse_mm(),
              report.altitude_plane.ground_truth.rmse_mm(), report.fill_at(0.3).ground_truth.rmse_mm());
}

ProcessGroup join_others(const TrainConfig& config) {
  const ComputeConfig& c = config.compute;
  const ProcessGroup group = ProcessGroup::from_environment(find_device(c.device).is_cuda(),
                                                            std::chrono::seconds(c.distributed_timeout_s));
  if (group.size() > 1) spdlog::info("{} processes share every batch", group.size());
  if (group.rank() > 0) spdlog::set_level(spdlog::level::warn);  // rank 0 says it for all
  return group;
}

/// Rank 0 makes it; the others find it there.
RunFolder new_folder(const std::string& path, const TrainConfig& config, const ProcessGroup& group) {
  if (group.rank() == 0) {
    RunFolder folder(path);
    folder.write("config.yaml", print_config(config));
    folder.write("provenance.yaml", "git_revision: " + git_revision() + "\ndataset: " + config.dataset +
                                        "\ndata_hash: " + data_hash(config.dataset) + "\n");
  }
  group.barrier();
  return RunFolder(path, RunFolder::Open::kExisting);
}

int train(const TrainConfig& config, RunFolder& folder, const ProcessGroup& group, bool resume) {
  DatasetSource training(config.dataset, config.split, SplitPart::kTraining, /*with_dense=*/false);
  std::optional<DatasetSource> validation = validation_source(config);
  Trainer trainer(config, training, validation ? &*validation : nullptr, folder, group);
  if (resume) trainer.resume();
  spdlog::info("{} samples to learn from, {} held out, {} threads", training.size(),
               validation ? validation->size() : 0, at::get_num_threads());
  if (read_dataset_info(config.dataset).rig.baseline_m == 0) {
    spdlog::info(
        "mono data set: the photometric loss compares images in time alone, depth maps are not judged by "
        "stereo");
  }
  trainer.run();
  if (const auto report = trainer.evaluate_best()) print_result(*report);
  if (group.rank() == 0) std::printf("wrote %s\n", folder.file("best.pt").string().c_str());
  return kExitOk;
}

int benchmark(const TrainConfig& config, const Options& options) {
  DatasetSource training(config.dataset, config.split, SplitPart::kTraining, /*with_dense=*/false);
  const TrainingBenchmark result = benchmark_training(config, training, options.benchmark_steps);
  std::fputs((options.json ? result.json() : result.table()).c_str(), stdout);
  return kExitOk;
}

int resume(const Options& options) {
  if (!options.config.file.empty() || !options.output.empty()) {
    throw ConfigError(
        "--resume takes the run's own configuration and folder; leave out --config and --output");
  }
  RunFolder folder(options.resume, RunFolder::Open::kExisting);
  const auto config = load_config<TrainConfig>(folder.file("config.yaml"), options.config.overrides);
  return train(config, folder, join_others(config), true);
}

int run(const Options& options) {
  if (!options.resume.empty()) return resume(options);
  const auto config = load<TrainConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.print_model) {
    const std::string table =
        describe_network(DepthCompletionNet(config.model), options.model_size_px, options.model_size_px);
    std::fputs(table.c_str(), stdout);
    return kExitOk;
  }
  if (options.benchmark) return benchmark(config, options);
  if (options.output.empty())
    throw ConfigError("--output is missing: name the folder that the run is written to");
  const ProcessGroup group = join_others(config);
  RunFolder folder = new_folder(options.output, config, group);
  return train(config, folder, group, false);
}

}  // namespace

int main(int argc, char** argv) {
  alight::restart_with_short_spin(argv);
  alight::keep_freed_memory();
  CLI::App app("alight-train: learns depth completion from a data set of alight-dataset");
  Options options;
  add_options(app, options);
  PlotCommand plot;
  CLI::App* plot_app = add_plot_command(app, plot);
  return run_tool(app, argc, argv, [&] { return plot_app->parsed() ? run_plot(plot) : run(options); });
}
