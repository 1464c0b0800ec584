#pragma once

#include <string>
#include <vector>

#include "foundation/command_line.hpp"
#include "train/logging/run_plot.hpp"

namespace alight {

/// What `alight-train plot` was told.
struct PlotCommand {
  std::vector<std::string> runs;
  std::string output;
  PlotOptions options;
};

/// Adds the subcommand `plot`, which fills `command`.
CLI::App* add_plot_command(CLI::App& app, PlotCommand& command);

/// @returns the exit code. @throws ConfigError if the output is no PNG, DataError as plot_runs
int run_plot(const PlotCommand& command);

}  // namespace alight
