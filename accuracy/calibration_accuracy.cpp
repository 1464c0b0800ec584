// The table of scripts/bench/calibration.sh: simulated boards before random mountings, calibrated and held against the
// truth.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <spdlog/spdlog.h>

#include "calibrate/lidar/lidar_calibration.hpp"
#include "foundation/command_line.hpp"
#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "sim/record/board_recorder.hpp"

namespace {

namespace fs = std::filesystem;
using alight::Vector6d;

struct Options {
  int mountings = 20;
  int first_seed = 1;
  fs::path work;
  alight::ConfigOptions config;
};

struct Row {
  int seed = 0;
  int boards = 0;
  Vector6d error = Vector6d::Zero();  // truth - estimate: metres, radians, camera frame
  Vector6d sigma = Vector6d::Zero();
  double rmse_px = 0;
  double seconds = 0;

  double shift_m() const { return error.head<3>().norm(); }
  double turn_deg() const { return alight::to_degrees(error.tail<3>().norm()); }
  int inside() const { return static_cast<int>((error.array().abs() <= 3 * sigma.array()).count()); }
};

Row run(const alight::sim::BoardSceneConfig& scenes, const fs::path& folder) {
  const auto bags = alight::sim::record_boards(scenes, folder);
  const alight::Rig rig = alight::load_rig(folder / "rig.yaml");
  const alight::Chessboard board{scenes.board.columns, scenes.board.rows, scenes.board.square_m};
  const auto start = std::chrono::steady_clock::now();
  const alight::LidarCalibration result = alight::calibrate_lidar(bags, rig, board, {});
  Row row;
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Eigen::Isometry3d truth = alight::load_rig(folder / "truth" / "rig.yaml").lidar0->T_camera_lidar;
  const Eigen::Isometry3d& found = result.extrinsics.T_camera_lidar;
  row.error << truth.translation() - found.translation(),
      alight::rotation_log(truth.linear() * found.linear().transpose());
  row.sigma = result.extrinsics.sigma();
  row.rmse_px = result.extrinsics.rmse_px;
  for (const auto& b : result.extrinsics.boards) row.boards += b.used ? 1 : 0;
  return row;
}

int print_summary(const std::vector<Row>& rows, int failed) {
  std::vector<double> shifts;
  std::vector<double> turns;
  int inside = 0;
  double squares = 0;
  for (const Row& row : rows) {
    shifts.push_back(row.shift_m());
    turns.push_back(row.turn_deg());
    inside += row.inside();
    squares += (row.error.array() / row.sigma.array()).square().sum();
  }
  const double components = 6.0 * static_cast<double>(rows.size());
  const double share = rows.empty() ? 0 : inside / components;
  bool small = false;
  if (!rows.empty()) {
    const double worst_turn_deg = *std::max_element(turns.begin(), turns.end());
    const double worst_shift_m = *std::max_element(shifts.begin(), shifts.end());
    const double turn_deg = alight::median(turns);
    const double shift_m = alight::median(shifts);
    small = turn_deg < 0.1 && shift_m < 0.01 && worst_turn_deg < 0.3 && worst_shift_m < 0.03;
    std::printf("\n| | median | worst | required |\n|---|---:|---:|---|\n");
    std::printf("| rotation | %.4f deg | %.4f deg | < 0.1, < 0.3 deg |\n", turn_deg, worst_turn_deg);
    std::printf("| translation | %.2f mm | %.2f mm | < 10, < 30 mm |\n", 1e3 * shift_m, 1e3 * worst_shift_m);
    std::printf("| components inside 3 sigma | %.1f %% | | >= 95 %% |\n", 100 * share);
    std::printf("| error over sigma, RMS | %.2f | | near 1 |\n", std::sqrt(squares / components));
  }
  const bool good = failed == 0 && small && share >= 0.95;
  std::printf("\n%s\n", good ? "All requirements are met." : "NOT all requirements are met.");
  return good ? alight::kExitOk : alight::kExitFailure;
}

int bench(const Options& options) {
  auto scenes = alight::load<alight::sim::BoardSceneConfig>(options.config);
  if (alight::print_if_asked(options.config, scenes)) return alight::kExitOk;
  if (options.work.empty()) throw alight::ConfigError("--work: is missing; name a folder for the recordings");
  std::printf(
      "| mounting | boards | rotation error [deg] | translation error [mm] | sigma rotation, max [deg] | "
      "sigma "
      "translation, max [mm] | components inside 3 sigma | RMSE [px] | time [s] |\n");
  std::printf("|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  std::vector<Row> rows;
  int failed = 0;
  for (int i = 0; i < options.mountings; ++i) {
    scenes.seed = options.first_seed + i;
    const fs::path folder = options.work / ("mounting_" + std::to_string(scenes.seed));
    try {
      const Row row = run(scenes, folder);
      std::printf("| %d | %d | %.4f | %.2f | %.4f | %.2f | %d of 6 | %.3f | %.1f |\n",
                  static_cast<int>(scenes.seed), row.boards, row.turn_deg(), 1e3 * row.shift_m(),
                  alight::to_degrees(row.sigma.tail<3>().maxCoeff()), 1e3 * row.sigma.head<3>().maxCoeff(),
                  row.inside(), row.rmse_px, row.seconds);
      rows.push_back(row);
    } catch (const alight::DataError& e) {
      std::printf("| %d | refused: %s |\n", static_cast<int>(scenes.seed), e.what());
      ++failed;
    }
    std::fflush(stdout);
    fs::remove_all(folder);
  }
  return print_summary(rows, failed);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Calibrates a LiDAR to a camera before many simulated mountings and holds the results against the "
      "truth",
      "calibration_bench");
  app.footer("Examples:\n  calibration_bench --config configs/sim/board.yaml --work /tmp/boards");
  Options options;
  alight::add_config_options(app, options.config);
  app.add_option("--work", options.work, "Folder for the recordings, removed one by one (90 MB at a time)");
  app.add_option("--mountings", options.mountings, "How many")->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "Seed of the first")->capture_default_str();
  return alight::run_tool(app, argc, argv, [&] { return bench(options); });
}
