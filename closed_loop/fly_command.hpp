#pragma once

#include "closed_loop/sim_commands.hpp"

namespace alight::closed_loop {

/// Flies and records logs with their truth: alight-sim without a subcommand.
Command add_fly_command(CLI::App& app);
/// Records boards for calibration.
Command add_board_command(CLI::App& app);
/// Holds landing sites against the truth.
Command add_score_command(CLI::App& app);

}  // namespace alight::closed_loop
