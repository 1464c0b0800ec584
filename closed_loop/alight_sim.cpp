#include <string>
#include <vector>

#include "closed_loop/campaign_command.hpp"
#include "closed_loop/fly_command.hpp"
#include "closed_loop/land_command.hpp"
#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"

namespace {

/// With fallthrough, a subcommand takes the options of flying without one, too, and would say nothing about them.
void refuse(const std::vector<CLI::Option*>& options, const CLI::App& app, const std::string& command) {
  for (const CLI::Option* option : options) {
    if (option == app.get_help_ptr() || option->count() == 0) continue;
    throw alight::ConfigError(option->get_name() + ": is no option of " + app.get_name() + " " + command +
                              "; alight-sim " + command + " --help lists those");
  }
}

}  // namespace

int main(int argc, char** argv) {
#ifdef ALIGHT_SIM_WITH_NETWORK
  alight::restart_with_short_spin(argv);
  alight::keep_freed_memory();
#endif
  CLI::App app(
      "Flies a simulated vehicle over made-up places: writes ROS bags with their truth, or lands with the "
      "onboard program in the loop.",
      "alight-sim");
  app.footer(
      "Examples:\n"
      "  alight-sim --config configs/sim/demo.yaml --output logs/\n"
      "  alight-sim --config configs/sim/demo.yaml --output logs/ --flight village_held_out --set "
      "sensors.noise=off\n"
      "  alight-sim --print-config > my_flights.yaml\n"
      "  alight-sim board --config configs/sim/board.yaml --output boards/\n"
      "  alight-sim score --truth logs/village_held_out.truth --results out/results.jsonl --require-accepted "
      "1\n"
      "  alight-sim land --world 7 --config configs/landing/default.yaml --output out/landing\n"
      "  alight-sim campaign --worlds 1000 --faults all --output out/campaign --jobs 2");
  app.fallthrough();  // -q, -v and --version also after the subcommand
  const alight::closed_loop::Command fly = alight::closed_loop::add_fly_command(app);
  const std::vector<CLI::Option*> fly_options = app.get_options();
  const std::vector<alight::closed_loop::Command> commands = {
      alight::closed_loop::add_board_command(app), alight::closed_loop::add_score_command(app),
      alight::closed_loop::add_land_command(app), alight::closed_loop::add_campaign_command(app)};
  return alight::run_tool(app, argc, argv, [&] {
    for (const auto& command : commands) {
      if (!command.app->parsed()) continue;
      refuse(fly_options, app, command.app->get_name());
      return command.run();
    }
    return fly.run();
  });
}
