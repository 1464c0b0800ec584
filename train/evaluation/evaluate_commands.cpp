#include "train/evaluation/evaluate_commands.hpp"

#include <cstdio>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "foundation/output_folder.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"
#include "infer/replay/replay.hpp"
#include "train/evaluation/methods/network_method.hpp"
#include "train/evaluation/scores/depth_check.hpp"
#include "train/evaluation/scores/depth_file.hpp"
#include "train/evaluation/scores/whole_dataset.hpp"
#include "train/evaluation/scores/worst_samples.hpp"
#include "train/evaluation/table.hpp"
#include "train/train_config.hpp"

namespace alight {
namespace {

std::vector<double> parse_block(const std::string& text) {
  double begin = 0;
  double end = 0;
  int used = 0;
  const bool read = std::sscanf(text.c_str(), "%lf:%lf%n", &begin, &end, &used) == 2 &&
                    static_cast<std::size_t>(used) == text.size();
  if (read && begin >= 0 && begin < end && end <= 1) return {begin, end};
  throw ConfigError("--blocks: \"" + text +
                    "\" is no block; write begin:end, shares of a flight within 0..1, such "
                    "as 0.4:0.6");
}

EvaluationConfig resolve(const EvaluateOptions& options) {
  auto config = load<EvaluationConfig>(options.config);
  if (!options.flights.empty()) config.flights = options.flights;
  if (options.every > 0) config.every = options.every;
  if (!options.split.empty()) config.split = load_config<TrainConfig>(input_file(options.split)).split;
  if (options.part) config.part = *options.part;
  if (options.blocks.empty()) return config;
  config.part = EvaluatedPart::kHeldOut;
  config.split = {};
  for (const std::string& block : options.blocks) config.split.held_out_blocks.push_back(parse_block(block));
  return config;
}

DepthMethods make_methods(const EvaluateOptions& options, const EvaluationConfig& config) {
  DepthMethods methods;
  for (const std::string& checkpoint : options.checkpoints) {
    methods.push_back(make_network_method(checkpoint, load_network(input_file(checkpoint))));
  }
  for (auto& baseline : make_baselines(config.baselines)) methods.push_back(std::move(baseline));
  return methods;
}

/// What a reader has to know to make the table again.
std::vector<std::pair<std::string, std::string>> about(const EvaluateOptions& options,
                                                       const EvaluationConfig& config,
                                                       const std::vector<EvaluationItem>& items) {
  std::vector<std::pair<std::string, std::string>> lines{{"data set", options.data},
                                                         {"flights", flight_list(items)},
                                                         {"every n-th sample", std::to_string(config.every)}};
  std::string blocks;
  for (const auto& block : config.split.held_out_blocks) {
    blocks += fmt::format("{}{:g} to {:g}", blocks.empty() ? "" : ", ", block[0], block[1]);
  }
  switch (config.part) {
    case EvaluatedPart::kAll:
      break;
    case EvaluatedPart::kHeldOut:
      lines.emplace_back("part", "of every flight's duration: " + blocks);
      break;
    case EvaluatedPart::kTraining:
      lines.emplace_back("part", "what is trained on");
      break;
    case EvaluatedPart::kUnknown:
      lines.emplace_back("part", "flights that are never trained on");
      break;
    case EvaluatedPart::kAllButTraining:
      lines.emplace_back("part", "flights that are never trained on, and of the others: " + blocks);
      break;
  }
  return lines;
}

void check_options(const EvaluateOptions& options) {
  if (options.data.empty()) throw ConfigError("--data is missing: name a data set of alight-dataset build");
  if (options.output.empty())
    throw ConfigError("--output is missing: name the table to write, .md, .csv or .json");
  check_table_path(options.output);
}

}  // namespace

int run_evaluate(const EvaluateOptions& options) {
  const EvaluationConfig config = resolve(options);
  if (print_if_asked(options.config, config)) return kExitOk;
  check_options(options);
  WholeDataset source(options.data);
  const std::vector<EvaluationItem> items = choose_items(sample_times(source.dataset()), config);
  const DepthMethods methods = make_methods(options, config);
  std::optional<OutputFolder> pictures;
  if (!options.pictures.empty()) pictures.emplace(options.pictures);

  ProgressBar bar("evaluate", static_cast<std::int64_t>(items.size()), "samples");
  EvaluationReport report =
      evaluate(methods, source, items, source.dataset().info().rig, config, [&] { bar.advance(); });
  bar.finish();
  report.about = about(options, config, items);
  write_table(report, options.output);
  std::printf("wrote %s\n", options.output.c_str());
  if (pictures) {
    write_worst_samples(report, *methods.front(), source, config, options.picture_count, pictures->partial());
    pictures->commit();
    std::printf("wrote %s: the worst samples of %s, %s\n", options.pictures.c_str(),
                methods.front()->name().c_str(), config.picture_feeding.c_str());
  }
  return kExitOk;
}

int run_depth(const DepthOptions& options) {
  const ReplayConfig infer =
      options.config.empty() ? ReplayConfig() : load_config<ReplayConfig>(input_file(options.config));
  const ImageTaskConfig& image = infer.engine.image;
  const Rig rig = load_rig(input_file(options.rig));
  DepthCheckInput input;
  input.left = read_image_file(options.left);
  input.right = read_image_file(options.right);
  input.depth_m = read_depth_file(options.depth);
  if (!options.sparse.empty()) input.sparse_m = read_depth_file(options.sparse);
  if (!options.truth.empty()) input.truth_m = read_depth_file(options.truth);
  const DepthCheckConfig config{image.self_evaluation.stereo, image.interpolation, image.lidar_half_fov_deg,
                                options.centre_cropped};
  std::fputs(format_check(check_depth(input, rig, config)).c_str(), stdout);
  return kExitOk;
}

}  // namespace alight
