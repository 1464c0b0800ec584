#pragma once

#include "closed_loop/sim_commands.hpp"

namespace alight::closed_loop {

/// Many landings, each in a process of its own.
Command add_campaign_command(CLI::App& app);

}  // namespace alight::closed_loop
