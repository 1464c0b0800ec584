#include "dataset/align_command.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "calibrate/clocks/align_picture.hpp"
#include "calibrate/clocks/turn_search.hpp"
#include "foundation/errors.hpp"
#include "foundation/shipped_files.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace {

std::string describe(const char* sensor, const ClockOffset& clock) {
  std::string line = std::string(sensor) + "  ";
  if (!clock.told) return line + "cannot be told: " + clock.reason + "\n";
  return line +
         fmt::format("{:>+7.1f} ms  +- {:.1f} ms (1 sigma)\n", 1e3 * clock.offset_s, 1e3 * clock.sigma_s);
}

}  // namespace

std::string format_clock_alignment(const ClockAlignment& alignment, const Rig& rig) {
  std::string report = "offset to the poses' clock, on top of the rig file's time shifts:\n";
  report += describe("camera", alignment.camera) + describe("LiDAR ", alignment.lidar);
  if (!alignment.turns.empty())
    report += fmt::format("turns by images and by poses correlate by {:.4f}\n", alignment.correlation);
  if (alignment.stands_out > 0)
    report += fmt::format(
        "depth edges stand out on image edges by {:.1f} standard deviations (chance stays below {:.1f})\n",
        alignment.stands_out, kStandsOut);
  if (!alignment.camera.told && !alignment.lidar.told) return report;
  report += "\nFor the rig file:\n";
  if (alignment.camera.told) {
    report += fmt::format("cam0:\n  timeshift_cam_imu: {:.4f}\n",
                          rig.cam0.timeshift_cam_imu_s + alignment.camera.offset_s);
    if (rig.cam1)
      report += fmt::format("cam1:\n  timeshift_cam_imu: {:.4f}\n",
                            rig.cam1->timeshift_cam_imu_s + alignment.camera.offset_s);
  }
  if (alignment.lidar.told && rig.lidar0)
    report +=
        fmt::format("lidar0:\n  timeshift: {:.4f}\n", rig.lidar0->timeshift_s + alignment.lidar.offset_s);
  return report;
}

CLI::App* add_align(CLI::App& app, AlignOptions& options) {
  CLI::App* align =
      app.add_subcommand("align", "Find how far the clocks of camera and LiDAR are off the poses'");
  add_config_options(*align, options.config);
  align->add_option("log", options.log, "A ROS 1 bag of a flight that turns");
  align->add_option("-r,--rig", options.rig, "Rig file whose time shifts are to be found");
  align->add_option("-p,--picture", options.picture,
                    "PNG to write: scores over the offsets, turns over time");
  align->footer(
      "Exit codes: 0 both offsets told, 4 one of them cannot be told (1 failure, 2 usage, as every tool)\n"
      "Examples:\n  alight-dataset align a.bag --rig configs/rigs/paper.yaml --picture clocks.png");
  return align;
}

int run_align(const AlignOptions& options) {
  const auto config = load<ClockAlignmentConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.log.empty()) throw ConfigError("the log is missing; name the bag of a flight");
  if (options.rig.empty()) throw ConfigError("--rig: is missing; name the rig file");
  const Rig rig = load_rig(input_file(options.rig));
  const ClockAlignment alignment =
      align_clocks(read_flight_views_with_bar(options.log, rig, config.log, config.views), config);
  std::fputs(format_clock_alignment(alignment, rig).c_str(), stdout);
  if (!options.picture.empty()) write_picture(options.picture, draw_clock_alignment(alignment));
  return alignment.camera.told && alignment.lidar.told ? kExitOk : kExitOffsetNotTold;
}

}  // namespace alight
