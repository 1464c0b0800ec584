#include <map>
#include <optional>
#include <string>

#include "train/evaluation/evaluate_commands.hpp"
#include "train/evaluation/self_command.hpp"

namespace {

using alight::EvaluatedPart;

void add_part_option(CLI::App& app, std::optional<EvaluatedPart>& part) {
  std::map<std::string, EvaluatedPart> parts;
  for (const EvaluatedPart each : {EvaluatedPart::kAll, EvaluatedPart::kTraining, EvaluatedPart::kHeldOut,
                                   EvaluatedPart::kUnknown, EvaluatedPart::kAllButTraining}) {
    parts[alight::name(each)] = each;
  }
  app.add_option("--part", part,
                 "Which part of the split: all, training, held_out, unknown or all_but_training")
      ->transform(CLI::CheckedTransformer(parts));
}

void add_evaluate_options(CLI::App& app, alight::EvaluateOptions& options) {
  alight::add_config_options(app, options.config);
  app.add_option("--checkpoint", options.checkpoints,
                 "Trained network; repeat to compare; without: baselines alone")
      ->allow_extra_args(false);
  app.add_option("-d,--data", options.data, "Data set of alight-dataset build");
  app.add_option("-o,--output", options.output, "Table to write: .md, .csv or .json");
  app.add_option("--flights", options.flights, "Only these flights, comma-separated")->delimiter(',');
  app.add_option("--split", options.split, "Take the split of this configuration of alight-train");
  add_part_option(app, options.part);
  app.add_option(
         "--blocks", options.blocks,
         "Only these parts of every flight's duration, such as 0.4:0.6,0.8:0.9; in place of split and part")
      ->delimiter(',');
  app.add_option("--every", options.every, "Every n-th sample of a flight")->check(CLI::PositiveNumber);
  app.add_option("--pictures", options.pictures,
                 "Folder to make: pictures of the samples on which the first method errs most");
  app.add_option("--picture-count", options.picture_count, "How many")
      ->capture_default_str()
      ->check(CLI::Range(1, 99));
  app.footer(
      "Examples:\n"
      "  alight-evaluate --checkpoint runs/demo/best.pt --data data/demo --output table.md\n"
      "  alight-evaluate --data data/demo --output baselines.json --every 10\n"
      "  alight-evaluate --checkpoint runs/a/best.pt --data data/ten --output unknown.md --split "
      "runs/a/config.yaml "
      "--part unknown\n"
      "  alight-evaluate --checkpoint runs/demo/best.pt --data data/demo --output table.csv --flights meadow "
      "--blocks 0.4:0.6 --pictures out/worst\n"
      "  alight-evaluate --print-config\n"
      "  alight-evaluate depth --help");
}

void add_depth_options(CLI::App& app, alight::DepthOptions& options) {
  app.add_option("--rig", options.rig, "Rig file; two cameras suffice")->required();
  app.add_option("--left", options.left, "Rectified left image")->required();
  app.add_option("--right", options.right, "Rectified right image")->required();
  app.add_option("--depth", options.depth,
                 "Depth map to judge: 16-bit PNG in 1/256 m, 32-bit TIFF or EXR in metres")
      ->required();
  app.add_option("--sparse", options.sparse, "LiDAR depth, for sim_d");
  app.add_option("--truth", options.truth, "True depth, for RMSE, MAE, REL and delta");
  app.add_option("-c,--config", options.config, "Configuration of alight-infer, for the test's thresholds");
  app.add_flag("--centre-cropped", options.centre_cropped,
               "The images are the centres of what the rig's cameras see, as those of a data set");
  app.footer(
      "Examples:\n"
      "  alight-evaluate depth --rig rig.yaml --left l.png --right r.png --depth d.png\n"
      "  alight-evaluate depth --rig configs/rigs/paper.yaml --centre-cropped --left "
      "data/demo/a/left/000000.png "
      "--right data/demo/a/right/000000.png --depth d.tiff --sparse data/demo/a/depth/000000.png --truth "
      "data/demo/a/dense/000000.png --config configs/infer/paper.yaml");
}

void add_self_options(CLI::App& app, alight::SelfOptions& options) {
  app.add_option("--checkpoint", options.checkpoint, "Trained network");
  app.add_option("-d,--data", options.data, "Data set of simulated flights, which have the true depth");
  app.add_option("-o,--output", options.output, "Document to write, .md");
  app.add_option("--figure", options.figure, "ROC curves to draw, .png");
  app.add_option("--scores", options.scores, "Table with a line a depth map to write, .csv");
  app.add_option("-c,--config", options.config, "Configuration of alight-infer, for the tests' thresholds");
  app.add_option("--split", options.split, "Take the split of this configuration of alight-train");
  add_part_option(app, options.part);
  app.add_option("--flights", options.flights, "Only these flights, comma-separated")->delimiter(',');
  app.add_option("--windows", options.windows_s, "Seconds of LiDAR fed, comma-separated; 0: the image alone")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  app.add_option(
         "--good", options.good,
         "What good depth is, share:metres:share_of_depth; the first counts, more show how much hangs on it")
      ->delimiter(',');
  app.add_option("--every", options.every, "Every n-th sample of a flight")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "Samples at once; 0: all cores")->check(CLI::Range(0, 1024));
  app.footer(
      "Examples:\n"
      "  alight-evaluate self --checkpoint runs/ten/best.pt --data data/ten --output self.md --figure "
      "self.png\n"
      "  alight-evaluate self --checkpoint runs/ten/best.pt --data data/ten --output self.md --split "
      "runs/ten/config.yaml --part unknown --every 10 --good 0.95:0.1:0.01,0.9:0.2:0.02 --scores self.csv");
}

}  // namespace

int main(int argc, char** argv) {
  alight::restart_with_short_spin(argv);
  CLI::App app{"Judges depth completion beside interpolation, and single depth maps by the stereo test",
               "alight-evaluate"};
  app.require_subcommand(0, 1)->fallthrough();  // -q and -v also after the subcommand
  alight::EvaluateOptions evaluate;
  add_evaluate_options(app, evaluate);
  alight::DepthOptions depth;
  CLI::App* depth_app =
      app.add_subcommand("depth", "Judge one depth map with the stereo pair that it belongs to");
  add_depth_options(*depth_app, depth);
  alight::SelfOptions self;
  CLI::App* self_app =
      app.add_subcommand("self", "Judge the self-evaluation: does it tell good depth from bad?");
  add_self_options(*self_app, self);
  return alight::run_tool(app, argc, argv, [&] {
    if (self_app->parsed()) return alight::run_self(self);
    return depth_app->parsed() ? alight::run_depth(depth) : alight::run_evaluate(evaluate);
  });
}
