#include "dataset/align_command.hpp"
#include "dataset/dataset_commands.hpp"
#include "dataset/inspect_command.hpp"

namespace {

CLI::App* add_build(CLI::App& app, alight::BuildArguments& build) {
  CLI::App* build_app = app.add_subcommand("build", "Make a data set of ROS 1 bags");
  alight::add_config_options(*build_app, build.config);
  build_app->add_option("-l,--log", build.logs, "A ROS 1 bag; repeat for more flights")
      ->allow_extra_args(false);
  build_app->add_option("-o,--output", build.output, "Folder to make, or an earlier data set to add to");
  build_app->add_option("-j,--jobs", build.jobs, "Logs read at a time (default: one a core)")
      ->check(CLI::PositiveNumber);
  build_app->add_option("--shard", build.shard, "i/N: only every N-th of the logs, from the i-th; see merge");
  build_app->footer(
      "Examples:\n"
      "  alight-dataset build --config configs/dataset/default.yaml --log a.bag --output data/demo\n"
      "  alight-dataset build --log a.bag --set depth_map.window_after_s=0.5 --output data/short\n"
      "  alight-dataset build --log a.bag --log b.bag --output data/demo          adds b, a is up to date\n"
      "  alight-dataset build --log a.bag --log b.bag --shard 2/2 --output data/part_2\n"
      "A log that cannot be read is named and left out (exit code 1); the others are built.");
  return build_app;
}

CLI::App* add_merge(CLI::App& app, alight::MergeArguments& merge) {
  CLI::App* merge_app = app.add_subcommand("merge", "Make one data set of several, such as those of --shard");
  merge_app->add_option("parts", merge.parts, "Data sets of one configuration and rig")->required();
  merge_app->add_option("-o,--output", merge.output, "Folder to make; must not exist")->required();
  merge_app->footer(
      "Examples:\n"
      "  alight-dataset merge data/part_1 data/part_2 --output data/demo\n"
      "Files are linked where the file system can, else copied; the parts stay.");
  return merge_app;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"From flight logs to data sets of images with sparse depth maps", "alight-dataset"};
  app.require_subcommand(1)->fallthrough();  // -q and -v also after the subcommand
  app.footer(
      "Examples:\n"
      "  alight-dataset build --config configs/dataset/default.yaml --log a.bag --log b.bag --output "
      "data/demo\n"
      "  alight-dataset merge data/part_1 data/part_2 --output data/demo\n"
      "  alight-dataset info data/demo\n"
      "  alight-dataset view data/demo --sample 12 --flight a --output sample.png\n"
      "  alight-dataset align a.bag --rig configs/rigs/paper.yaml");

  alight::BuildArguments build;
  const CLI::App* build_app = add_build(app, build);
  alight::MergeArguments merge;
  const CLI::App* merge_app = add_merge(app, merge);

  alight::InfoOptions info;
  CLI::App* info_app = app.add_subcommand("info", "Print what is in a data set and what it is like");
  info_app->add_option("dataset", info.dataset, "Folder of the data set")->required();
  info_app->add_option("-p,--picture", info.picture,
                       "PNG to write: heights, density over accumulation time, coverage");
  info_app->footer("Examples:\n  alight-dataset info data/demo --picture stats.png");

  alight::ViewOptions view;
  CLI::App* view_app =
      app.add_subcommand("view", "Draw one sample: image, sparse depth, time offsets, true depth");
  view_app->add_option("dataset", view.dataset, "Folder of the data set")->required();
  view_app->add_option("-n,--sample", view.sample, "Index in the flight")->capture_default_str();
  view_app->add_option("-f,--flight", view.flight, "Name of the flight (default: the first)");
  view_app->add_option("-o,--output", view.output, "PNG to write")->required();
  view_app->footer("Examples:\n  alight-dataset view data/demo --sample 12 --flight a --output sample.png");

  std::string inspected;
  CLI::App* inspect_app = app.add_subcommand(
      "inspect", "Print what a ROS 1 bag holds, what it could serve as, and the lines of a rig file for it");
  inspect_app->add_option("bag", inspected, "A ROS 1 bag")->required();
  inspect_app->footer("Examples:\n  alight-dataset inspect flight.bag");

  alight::AlignOptions align;
  const CLI::App* align_app = alight::add_align(app, align);

  return alight::run_tool(app, argc, argv, [&] {
    if (inspect_app->parsed()) return alight::run_inspect(inspected);
    if (align_app->parsed()) return alight::run_align(align);
    if (build_app->parsed()) return alight::run_build(build);
    if (merge_app->parsed()) return alight::run_merge(merge);
    if (info_app->parsed()) return alight::run_info(info);
    return alight::run_view(view);
  });
}
