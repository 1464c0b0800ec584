#include "calibrate/commands.hpp"

namespace {

void add_board_options(CLI::App& app, std::string& board, double& square_m) {
  app.add_option("-b,--board", board,
                 "Inner corners of the chessboard, as 9x6 (one less than squares each way)");
  app.add_option("-s,--square-m", square_m, "Side of a printed square in metres, measured with a ruler");
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
  CLI::App* stereo_app =
      app.add_subcommand("stereo", "Both lenses and the right camera's place, from images of a board");
  alight::add_config_options(*stereo_app, stereo.config);
  stereo_app->add_option("--left", stereo.left, "Images of the left camera, with * and ? (quoted)");
  stereo_app->add_option("--right", stereo.right,
                         "Images of the right camera, as many and in the same order");
  stereo_app->add_option("-l,--log", stereo.log, "Or a ROS 1 bag");
  stereo_app->add_option("--left-topic", stereo.left_topic, "Topic of the left camera in the log");
  stereo_app->add_option("--right-topic", stereo.right_topic, "Topic of the right camera in the log");
  add_board_options(*stereo_app, stereo.board, stereo.square_m);
  stereo_app->add_option("-o,--output", stereo.output, "Rig file to make; must not exist");
  stereo_app->add_option("--report", stereo.report, "Folder to make for pictures and report");
  stereo_app->footer(
      "Examples:\n"
      "  alight-calibrate stereo --left 'left*.jpg' --right 'right*.jpg' --board 9x6 --square-m 0.025 "
      "--output rig.yaml\n"
      "  alight-calibrate stereo --log boards.bag --left-topic /left/image_raw --right-topic "
      "/right/image_raw --board "
      "9x6 --square-m 0.025 --set model=equidistant --output rig.yaml");

  alight::LidarOptions lidar;
  CLI::App* lidar_app =
      app.add_subcommand("lidar", "The LiDAR's place, from recordings of a board that stands still");
  alight::add_config_options(*lidar_app, lidar.config);
  lidar_app
      ->add_option("-l,--log", lidar.logs, "A ROS 1 bag with the board in one pose; repeat for more poses")
      ->allow_extra_args(false);
  lidar_app->add_option("-r,--rig", lidar.rig, "Rig file: the calibrated camera, topics of camera and LiDAR");
  add_board_options(*lidar_app, lidar.board, lidar.square_m);
  lidar_app->add_option("-o,--output", lidar.output, "Rig file to make; must not exist");
  lidar_app->add_option("--report", lidar.report, "Folder to make for pictures and report");
  lidar_app->footer(
      "Examples:\n"
      "  alight-calibrate lidar --log b1.bag --log b2.bag --log b3.bag --rig rig.yaml --board 6x4 --square-m "
      "0.12 "
      "--output rig2.yaml --report report/");

  alight::CheckOptions check;
  CLI::App* check_app =
      app.add_subcommand("check", "Whether LiDAR and cameras are still where the rig says, from any flight");
  alight::add_config_options(*check_app, check.config);
  check_app->add_option("-l,--log", check.log, "A ROS 1 bag of a flight: images, LiDAR, attitude, position");
  check_app->add_option("-r,--rig", check.rig, "Rig file to check");
  check_app->add_option("--report", check.report, "Folder to make for report and picture");
  check_app->footer(
      "Exit codes: 0 good, 3 moved, 4 cannot tell (1 failure, 2 usage, as every tool)\n"
      "Examples:\n"
      "  alight-calibrate check --log flight.bag --rig rig.yaml --report check/");

  return alight::run_tool(app, argc, argv, [&] {
    if (stereo_app->parsed()) return alight::run_stereo(stereo);
    if (check_app->parsed()) return alight::run_check(check);
    return alight::run_lidar(lidar);
  });
}
