#include "closed_loop/campaign_command.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>

#include "closed_loop/campaign/campaign.hpp"
#include "closed_loop/campaign/campaign_report.hpp"
#include "closed_loop/landing/land_config.hpp"
#include "closed_loop/landing/network_choice.hpp"
#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/processes/child_processes.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/rig/rig.hpp"

namespace alight::closed_loop {
namespace {

namespace fs = std::filesystem;

struct CampaignOptions {
  ConfigOptions config;
  CampaignPlan plan;
  fs::path output;
  int jobs = 1;
  bool report_only = false;
  std::optional<int> one;
};

/// One landing, in a process of its own: the parent starts this very program with --one.
int fly_one(const CampaignFolder& folder, int index) {
  const CampaignLanding landing = planned(folder.plan(), index);
  LandConfig config = folder.config();
  config.world.seed = landing.seed;
  config.world.look = landing.look;
  LandingFlight flight(config, landing.seed, choose_network(config, folder.plan().lidar_only), landing.fault);
  const FlownLanding flown = flight.fly();
  if (flown.result.outcome != Outcome::kSafe) {
    folder.write_pictures(flown, flight.surface_truth(), config.flight.body_radius_m);
  }
  folder.append(flown.result);
  return kExitOk;
}

void report(const CampaignFolder& folder, double wanted_radius_m) {
  const std::string page = campaign_report(folder.rows(), wanted_radius_m);
  write_file_atomically(folder.path() / "report.md", page);
  std::fputs(page.c_str(), stdout);
}

std::vector<std::string> all_looks() {
  std::vector<std::string> looks;
  for (const sim::Look look : sim::all_looks()) looks.push_back(sim::to_string(look));
  return looks;
}

void expand(CampaignPlan& plan) {
  if (plan.looks.empty()) plan.looks = all_looks();
  if (plan.faults == std::vector<std::string>{"all"}) {
    plan.faults.clear();
    for (const sim::Fault& fault : sim::all_faults()) plan.faults.push_back(fault.name);
  }
}

int run(CampaignOptions options) {
  auto config = load<LandConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.output.empty()) throw ConfigError("--output: is missing; name the folder of the campaign");
  if (options.one) return fly_one(CampaignFolder(options.output), *options.one);
  if (options.report_only) {
    report(CampaignFolder(options.output), config.flight.wanted_radius_m);
    return kExitOk;
  }
  expand(options.plan);
  check(options.plan);
  load_rig(input_file(config.rig));  // both say now what is missing
  choose_network(config, options.plan.lidar_only);
  const CampaignFolder folder(options.output, options.plan, config);
  const std::vector<int> missing = folder.missing();
  const std::string program = this_executable().string();
  int failed = 0;
  {
    ProgressBar progress("landings", static_cast<std::int64_t>(missing.size()), "landings");
    failed = run_programs(
        missing.size(), options.jobs,
        [&](std::size_t i) {
          return std::vector<std::string>{program,
                                          "--quiet",
                                          "campaign",
                                          "--output",
                                          options.output.string(),
                                          "--one",
                                          std::to_string(missing[i])};
        },
        [&] { progress.advance(); });
  }
  report(folder, config.flight.wanted_radius_m);
  if (failed == 0) return kExitOk;
  throw DataError(std::to_string(failed) + " of " + std::to_string(missing.size()) +
                  " landings ended without a row; run the same command again for those");
}

}  // namespace

Command add_campaign_command(CLI::App& app) {
  auto options = std::make_shared<CampaignOptions>();
  CLI::App* command = app.add_subcommand(
      "campaign",
      "Lands in many worlds, each in a process of its own, and reports; goes on where it was stopped");
  add_config_options(*command, options->config);
  CampaignPlan& plan = options->plan;
  command->add_option("-o,--output", options->output, "Folder of the campaign; made, or gone on with");
  command->add_option("--worlds", plan.worlds, "How many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command->add_option("--first-seed", plan.first_seed, "World i has this seed plus i")->capture_default_str();
  command->add_option("--looks", plan.looks, "Kinds of places, comma-separated; without: all")
      ->delimiter(',');
  command
      ->add_option("--faults", plan.faults, "Sensor failures by name, comma-separated, or all; without: none")
      ->delimiter(',');
  command->add_option("--fault-from", plan.fault_from_s, "Earliest second at which one strikes")
      ->capture_default_str();
  command->add_option("--fault-to", plan.fault_to_s, "Latest second")->capture_default_str();
  command
      ->add_option("--fault-duration", plan.fault_lasts_s,
                   "Shortest and longest time of a failure that passes, such as 2,10; without: all stay")
      ->delimiter(',')
      ->expected(2);
  command
      ->add_option("--lasting-share", plan.lasting_share,
                   "With --fault-duration: share (0..1) of the failures that stay all the same")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command->add_flag("--lidar-only", plan.lidar_only, "No network");
  command->add_option("-j,--jobs", options->jobs, "Landings at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_flag("--report", options->report_only, "Only report what was flown so far");
  command->add_option("--one", options->one, "Fly this landing of an existing campaign alone, here")
      ->group("");
  command->footer(
      "Examples:\n"
      "  alight-sim campaign --worlds 1000 --output out/campaign --jobs 2\n"
      "  alight-sim campaign --config configs/closed_loop/coarse.yaml --lidar-only --worlds 1000 --faults "
      "all "
      "--output out/faults\n"
      "  alight-sim campaign --report --output out/campaign");
  return {command, [options] { return run(*options); }};
}

}  // namespace alight::closed_loop
