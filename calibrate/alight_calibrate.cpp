#include "calibrate/check_command.hpp"
#include "calibrate/lidar_command.hpp"
#include "calibrate/stereo_command.hpp"

namespace {

void add_board_options(CLI::App& app, std::string& board, double& square_m) {
  app.add_option("-b,--board", board,
                 "Inner corners of the chessboard, as 9x6 (one less than squares each way)");
  app.add_option("-s,--square-m", square_m, "Side of a printed square in metres, measured with a ruler");
}

CLI::App* add_stereo(CLI::App& app, alight::StereoOptions& options) {
  CLI::App* command =
      app.add_subcommand("stereo", "Both lenses and the right camera's place, from images of a board");
  alight::add_config_options(*command, options.config);
  command->add_option("--left", options.left, "Images of the left camera, with * and ? (quoted)");
  command->add_option("--right", options.right, "Images of the right camera, as many and in the same order");
  command->add_option("-l,--log", options.log, "Or a ROS 1 bag");
  command->add_option("--left-topic", options.left_topic, "Topic of the left camera in the log");
  command->add_option("--right-topic", options.right_topic, "Topic of the right camera in the log");
  add_board_options(*command, options.board, options.square_m);
  command->add_option("-o,--output", options.output, "Rig file to make; must not exist");
  command->add_option("--report", options.report, "Folder to make for pictures and report");
  command->footer(
      "Examples:\n"
      "  alight-calibrate stereo --left 'left*.jpg' --right 'right*.jpg' --board 9x6 --square-m 0.025 "
      "--output rig.yaml\n"
      "  alight-calibrate stereo --log boards.bag --left-topic /left/image_raw --right-topic "
      "/right/image_raw --board "
      "9x6 --square-m 0.025 --set model=equidistant --output rig.yaml");
  return command;
}

CLI::App* add_lidar(CLI::App& app, alight::LidarOptions& options) {
  CLI::App* command =
      app.add_subcommand("lidar", "The LiDAR's place, from recordings of a board that stands still");
  alight::add_config_options(*command, options.config);
  command
      ->add_option("-l,--log", options.logs, "A ROS 1 bag with the board in one pose; repeat for more poses")
      ->allow_extra_args(false);
  command->add_option("-r,--rig", options.rig, "Rig file: the calibrated camera, topics of camera and LiDAR");
  add_board_options(*command, options.board, options.square_m);
  command->add_option("-o,--output", options.output, "Rig file to make; must not exist");
  command->add_option("--report", options.report, "Folder to make for pictures and report");
  command->footer(
      "Examples:\n"
      "  alight-calibrate lidar --log b1.bag --log b2.bag --log b3.bag --rig rig.yaml --board 6x4 --square-m "
      "0.12 "
      "--output rig2.yaml --report report/");
  return command;
}

CLI::App* add_check(CLI::App& app, alight::CheckOptions& options) {
  CLI::App* command =
      app.add_subcommand("check", "Whether LiDAR and cameras are still where the rig says, from any flight");
  alight::add_config_options(*command, options.config);
  command->add_option("-l,--log", options.log, "A ROS 1 bag of a flight: images, LiDAR, attitude, position");
  command->add_option("-r,--rig", options.rig, "Rig file to check");
  command->add_option("--report", options.report, "Folder to make for report and picture");
  command->footer(
      "Exit codes: 0 good, 3 moved, 4 cannot tell (1 failure, 2 usage, as every tool)\n"
      "Examples:\n"
      "  alight-calibrate check --log flight.bag --rig rig.yaml --report check/");
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Calibrates a rig by a printed chessboard and checks it by a flight (docs/calibration.md)",
               "alight-calibrate"};
  app.require_subcommand(1)->fallthrough();  // -q and -v also after the subcommand
  app.footer(
      "Examples:\n"
      "  alight-calibrate stereo --left 'left*.jpg' --right 'right*.jpg' --board 9x6 --square-m 0.025 "
      "--output rig.yaml\n"
      "  alight-calibrate lidar --log b1.bag --log b2.bag --log b3.bag --rig rig.yaml --board 6x4 --square-m "
      "0.12 "
      "--output rig2.yaml\n"
      "  alight-calibrate check --log flight.bag --rig rig2.yaml");

  alight::StereoOptions stereo;
  alight::LidarOptions lidar;
  alight::CheckOptions check;
  const CLI::App* stereo_app = add_stereo(app, stereo);
  add_lidar(app, lidar);
  const CLI::App* check_app = add_check(app, check);

  return alight::run_tool(app, argc, argv, [&] {
    if (stereo_app->parsed()) return alight::run_stereo(stereo);
    if (check_app->parsed()) return alight::run_check(check);
    return alight::run_lidar(lidar);
  });
}
