#include <vector>

#include "cli/command_line.hpp"
#include "closed_loop/commands.hpp"

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
  const std::vector<alight::closed_loop::Command> commands = {
      alight::closed_loop::add_board_command(app), alight::closed_loop::add_score_command(app),
      alight::closed_loop::add_land_command(app), alight::closed_loop::add_campaign_command(app)};
  return alight::run_tool(app, argc, argv, [&] {
    for (const auto& command : commands) {
      if (command.app->parsed()) return command.run();
    }
    return fly.run();
  });
}
