#include "train/evaluation/self_command.hpp"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "foundation/command_line.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"
#include "infer/replay/replay.hpp"
#include "train/evaluation/methods/network_method.hpp"
#include "train/evaluation/scores/whole_dataset.hpp"
#include "train/evaluation/self/self_figure.hpp"
#include "train/evaluation/self/self_markdown.hpp"
#include "train/evaluation/self/self_report.hpp"
#include "train/train_config.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

GoodDepth parse_good(const std::string& text) {
  GoodDepth good;
  int used = 0;
  const int read =
      std::sscanf(text.c_str(), "%lf:%lf:%lf%n", &good.share, &good.error_m, &good.error_relative, &used);
  const bool whole = read == 3 && static_cast<std::size_t>(used) == text.size();
  if (whole && good.share > 0 && good.share <= 1 && good.error_m >= 0 && good.error_relative >= 0)
    return good;
  throw ConfigError("--good: \"" + text +
                    "\" is no definition; write share:metres:share_of_depth, such as 0.95:0.1:0.01");
}

void check_file(const std::string& option, const fs::path& path, const std::string& extension) {
  if (path.extension() != extension)
    throw ConfigError(option + ": " + path.string() + " has to end in " + extension);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code code;
  if (!fs::is_directory(folder, code))
    throw DataError(path.string() + ": the folder " + folder.string() + " is not there; make it first");
}

void check_self_options(const SelfOptions& options) {
  if (options.checkpoint.empty()) throw ConfigError("--checkpoint is missing: name a trained network");
  if (options.data.empty()) throw ConfigError("--data is missing: name a data set of alight-dataset build");
  if (options.output.empty()) throw ConfigError("--output is missing: name the document to write, .md");
  check_file("--output", options.output, ".md");
  if (!options.figure.empty()) check_file("--figure", options.figure, ".png");
  if (!options.scores.empty()) check_file("--scores", options.scores, ".csv");
  if (options.part && *options.part != EvaluatedPart::kAll && options.split.empty())
    throw ConfigError(
        "--part needs --split: name the configuration of alight-train that the network was trained with");
}

SelfScoreConfig score_config(const SelfOptions& options) {
  SelfScoreConfig config;
  if (!options.config.empty())
    config.image = load_config<ReplayConfig>(input_file(options.config)).engine.image;
  if (!options.windows_s.empty()) config.windows_s = options.windows_s;
  config.threads = options.threads;
  if (options.good.empty()) return config;
  config.good.clear();
  for (const std::string& text : options.good) config.good.push_back(parse_good(text));
  return config;
}

EvaluationConfig sample_config(const SelfOptions& options) {
  EvaluationConfig config;
  config.flights = options.flights;
  config.every = options.every;
  if (!options.split.empty()) config.split = load_config<TrainConfig>(input_file(options.split)).split;
  config.part = options.part.value_or(EvaluatedPart::kAll);
  return config;
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ",") + word;
  return list;
}

/// What makes the same document again, with all that was not left to its default.
std::string command_line(const SelfOptions& options) {
  std::string line = "alight-evaluate self";
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + option + " " + value;
  };
  add("--checkpoint", options.checkpoint);
  add("--data", options.data);
  add("--split", options.split);
  if (options.part) add("--part", name(*options.part));
  add("--flights", joined(options.flights));
  if (options.every != 1) add("--every", std::to_string(options.every));
  add("--config", options.config);
  add("--good", joined(options.good));
  std::vector<std::string> windows;
  for (const double window_s : options.windows_s) windows.push_back(fmt::format("{:g}", window_s));
  add("--windows", joined(windows));
  add("--output", options.output);
  add("--figure", options.figure);
  add("--scores", options.scores);
  return line;
}

void write_png(const cv::Mat& image, const fs::path& path) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  write_file_atomically(path, std::string(bytes.begin(), bytes.end()));
}

/// The scores first, because they are there even where no curve can be drawn.
void write_report(SelfReport& report, const SelfOptions& options) {
  if (!options.scores.empty()) write_file_atomically(options.scores, to_csv(report));
  if (!options.figure.empty()) {
    write_png(draw_roc(report), options.figure);
    const fs::path folder = fs::absolute(options.output).parent_path();
    report.figure = fs::absolute(options.figure).lexically_relative(folder).string();
  }
  write_file_atomically(options.output, to_markdown(report));
  std::printf("wrote %s\n", options.output.c_str());
}

}  // namespace

int run_self(const SelfOptions& options) {
  check_self_options(options);
  SelfReport report;
  report.config = score_config(options);
  WholeDataset source(options.data);
  const std::vector<EvaluationItem> items =
      choose_items(sample_times(source.dataset()), sample_config(options));
  const auto network = make_network_method(options.checkpoint, load_network(input_file(options.checkpoint)));
  ProgressBar bar("self-evaluate", static_cast<std::int64_t>(items.size()), "samples");
  report.maps =
      score_maps(*network, source, items, source.dataset().info().rig, report.config, [&] { bar.advance(); });
  bar.finish();
  report.command = command_line(options);
  report.about = {{"flights", flight_list(items)}, {"samples", std::to_string(items.size())}};
  write_report(report, options);
  return kExitOk;
}

}  // namespace alight
