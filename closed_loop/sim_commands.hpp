#pragma once

#include <functional>
#include <memory>

#include <CLI/CLI.hpp>

#include "closed_loop/land_config.hpp"
#include "foundation/errors.hpp"
#include "infer/depth/depth_predictor.hpp"

namespace alight::closed_loop {

/// What alight-sim can do: its options, and what runs when it was asked for. `run` returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command add_fly_command(CLI::App& app);  ///< without a subcommand
Command add_board_command(CLI::App& app);
Command add_score_command(CLI::App& app);
Command add_land_command(CLI::App& app);
Command add_campaign_command(CLI::App& app);

/// The network that a landing flies with. @param lidar_only none: null. @throws ConfigError if there is none, or this
/// build has no LibTorch
std::shared_ptr<DepthPredictor> choose_network(const LandConfig& config, bool lidar_only);

}  // namespace alight::closed_loop
