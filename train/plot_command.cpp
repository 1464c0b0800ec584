#include "train/plot_command.hpp"

#include <filesystem>

namespace alight {

CLI::App* add_plot_command(CLI::App& app, PlotCommand& command) {
  CLI::App* plot =
      app.add_subcommand("plot", "Draw losses, learning rate and errors of runs over their epochs");
  plot->add_option("runs", command.runs, "Folders of runs, each with a metrics.csv")
      ->required()
      ->expected(1, static_cast<int>(kMaxPlottedRuns));
  plot->add_option("-o,--output", command.output, "PNG to write; must not exist yet")->required();
  plot->add_flag("-f,--force", command.options.overwrite, "Replace the PNG where it exists");
  plot->add_option("--width", command.options.width_px, "Width of the figure, pixels")
      ->capture_default_str()
      ->check(CLI::Range(400, 8000));
  plot->footer("Examples:\n  alight-train plot runs/demo runs/longer --output curves.png");
  return plot;
}

int run_plot(const PlotCommand& command) {
  const std::filesystem::path png = command.output;
  if (png.extension() != ".png")
    throw ConfigError("--output " + command.output + ": expected a name in .png");
  plot_runs({command.runs.begin(), command.runs.end()}, png, command.options);
  std::printf("wrote %s\n", command.output.c_str());
  return kExitOk;
}

}  // namespace alight
