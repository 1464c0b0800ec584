#pragma once

#include "closed_loop/sim_commands.hpp"

namespace alight::closed_loop {

/// One landing with the onboard program in the loop.
Command add_land_command(CLI::App& app);

}  // namespace alight::closed_loop
