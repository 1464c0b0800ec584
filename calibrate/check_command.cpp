#include "calibrate/check_command.hpp"

#include <cstdio>
#include <optional>

#include "calibrate/check/rig_check.hpp"
#include "calibrate/check/rig_check_report.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/shipped_files.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

int exit_code(RigVerdict verdict) {
  switch (verdict) {
    case RigVerdict::kGood:
      return kExitOk;
    case RigVerdict::kMoved:
      return kExitMoved;
    case RigVerdict::kCannotTell:
      break;
  }
  return kExitCannotTell;
}

}  // namespace

int run_check(const CheckOptions& options) {
  const auto config = load<RigCheckConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.log.empty()) throw ConfigError("--log: is missing; name the bag of a flight");
  if (options.rig.empty()) throw ConfigError("--rig: is missing; name the rig file to check");
  const Rig rig = load_rig(input_file(options.rig));
  std::optional<OutputFolder> report;
  if (!options.report.empty()) report.emplace(options.report);
  const FlightViews flight = read_flight_views_with_bar(options.log, rig, config.log, config.views);
  const RigCheck check = check_rig(flight, config);
  const std::string text = format_rig_check(check);
  std::fputs(text.c_str(), stdout);
  if (report) {
    write_file_atomically(report->partial() / "report.txt", text);
    write_file_atomically(report->partial() / "report.json", rig_check_json(check));
    write_picture(report->partial() / "edges.png", draw_rig_check(flight, check, config));
    report->commit();
  }
  return exit_code(check.verdict);
}

}  // namespace alight
