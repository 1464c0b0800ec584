#include "calibrate/lidar/lidar_calibration.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <future>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "calibrate/lidar/board_advice.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr std::array<double, 3> kFocals_px = {700, 1000, 500};  // of the LiDAR's image, tried in turn

/// The largest way of a corner between the first and the last third of the images.
double camera_motion_px(const StaticScene& scene, const Chessboard& board, const Corners& corners) {
  Corners first = corners;
  Corners last = corners;
  refine_corners(scene.first_third, board, first);
  refine_corners(scene.last_third, board, last);
  double motion = 0;
  for (std::size_t i = 0; i < first.size(); ++i) motion = std::max(motion, cv::norm(first[i] - last[i]));
  return motion;
}

/// Where the LiDAR measures a corner: along its ray, at its (not corrected) range.
Eigen::Vector3d measured_corner(const LidarBoard& seen, const Eigen::Vector3d& corner) {
  const Eigen::Vector3d p = seen.T_lidar_board * corner;
  return p * (1 + seen.range_offset_m / p.norm());
}

/// The largest way of an outer corner between the first and the second half of the points.
std::optional<double> lidar_motion_m(const std::vector<LidarReturn>& on_board, const Chessboard& board,
                                     bool dark, const LidarBoard& whole) {
  const std::int64_t middle_ns = on_board.front().t_ns + (on_board.back().t_ns - on_board.front().t_ns) / 2;
  const auto split = std::partition_point(on_board.begin(), on_board.end(),
                                          [&](const LidarReturn& point) { return point.t_ns < middle_ns; });
  const LidarBoardFit first = refit_lidar_board({on_board.begin(), split}, board, dark, whole);
  const LidarBoardFit last = refit_lidar_board({split, on_board.end()}, board, dark, whole);
  if (!first.board || !last.board) return std::nullopt;
  double motion = 0;
  for (const int i : {0, board.columns - 1, board.corners() - board.columns, board.corners() - 1}) {
    motion = std::max(motion, (measured_corner(*first.board, board.corner(i)) -
                               measured_corner(*last.board, board.corner(i)))
                                  .norm());
  }
  return motion;
}

std::string refuse_moving(const char* sensor, double motion, const char* unit, double limit) {
  return fmt::format(
      "the scene moves: a corner goes by {:.3g} {} in the {} (at most {:.3g}); put board and rig on stands, "
      "and let nobody touch them while recording",
      motion, unit, sensor, limit);
}

std::string look_with_camera(SceneResult& result, const Rig& rig, const Chessboard& board,
                             const LidarCalibrationConfig& config, BoardView& view) {
  result.camera_corners = find_chessboard(result.scene.image, board);
  if (!result.camera_corners) {
    // A moving board is smeared in the mean and sharp in a part of it.
    if (const auto early = find_chessboard(result.scene.first_third, board)) {
      const double motion = camera_motion_px(result.scene, board, *early);
      if (motion > config.max_camera_motion_px)
        return refuse_moving("camera image", motion, "px", config.max_camera_motion_px);
    }
    return "camera: " + why_not_found(result.scene.image, board);
  }
  const double motion = camera_motion_px(result.scene, board, *result.camera_corners);
  if (motion > config.max_camera_motion_px)
    return refuse_moving("camera image", motion, "px", config.max_camera_motion_px);
  for (const cv::Point2f& corner : *result.camera_corners) {
    const Eigen::Vector3d ray =
        rig.cam0.camera.unproject({static_cast<double>(corner.x), static_cast<double>(corner.y)});
    view.pixels.push_back(rig.cam0.camera.intrinsics.project(ray));
  }
  view.camera_first_dark = first_square_is_dark(result.scene.image, board, *result.camera_corners);
  return "";
}

std::string look_with_lidar(SceneResult& result, const Chessboard& board,
                            const LidarCalibrationConfig& config, BoardView& view) {
  // Coarse pixels hold many points and fill holes, fine ones resolve far boards: the first that shows the board wins.
  for (const double focal_px : kFocals_px) {
    LidarImage image = draw_lidar_image(result.scene.points, focal_px);
    auto corners = find_chessboard(image.reflectivity, board);
    if (!corners) continue;
    result.lidar_image = std::move(image);
    result.lidar_corners = std::move(corners);
    break;
  }
  if (!result.lidar_corners) return "LiDAR: " + why_not_found(result.lidar_image.reflectivity, board);
  view.lidar_first_dark = first_square_is_dark(result.lidar_image.reflectivity, board, *result.lidar_corners);
  const std::vector<LidarReturn> on_board =
      points_on_board(result.scene.points, result.lidar_image, board, *result.lidar_corners);
  const LidarBoardFit fit =
      fit_lidar_board(on_board, result.lidar_image, board, *result.lidar_corners, view.lidar_first_dark);
  if (!fit.board) return "LiDAR: " + fit.reason;
  view.lidar = *fit.board;
  const std::optional<double> motion = lidar_motion_m(on_board, board, view.lidar_first_dark, view.lidar);
  if (motion && *motion > config.max_lidar_motion_m)
    return refuse_moving("LiDAR's points", *motion, "m", config.max_lidar_motion_m);
  return "";
}

/// At most `threads` recordings at a time, in order. Bags are opened on this thread alone: rosbag loads a plugin for each,
/// which two threads may not do at once.
std::vector<SceneResult> observe_all(const std::vector<fs::path>& logs, const Rig& rig,
                                     const Chessboard& board, const LidarCalibrationConfig& config,
                                     const std::function<void()>& progress) {
  std::vector<SceneResult> scenes;
  std::deque<std::future<SceneResult>> running;
  const auto finish_one = [&] {
    scenes.push_back(running.front().get());
    running.pop_front();
    if (progress) progress();
  };
  for (const fs::path& log : logs) {
    StaticScene scene = read_static_scene(log, rig, config.scene);
    if (running.size() == static_cast<std::size_t>(config.threads)) finish_one();
    running.push_back(
        std::async(std::launch::async, [&rig, &board, &config, scene = std::move(scene)]() mutable {
          return observe_scene(std::move(scene), rig, board, config);
        }));
  }
  while (!running.empty()) finish_one();
  return scenes;
}

std::string list_refused(const std::vector<SceneResult>& scenes) {
  std::string list;
  for (const SceneResult& scene : scenes) {
    if (!scene.refused.empty()) list += "\n  " + scene.name + ": " + scene.refused;
  }
  return list;
}

}  // namespace

void bind(Binder& b, LidarCalibrationConfig& c) {
  b.section("scene", c.scene, "accumulating a recording");
  b.field("max_camera_motion_px", c.max_camera_motion_px, "a scene in which a corner moves more is refused",
          positive());
  b.field("max_lidar_motion_m", c.max_lidar_motion_m, "a scene in which a corner moves more is refused",
          positive());
  b.field("threads", c.threads, "recordings that are read at a time; the result does not depend on it",
          between(1, 64));
  b.section("extrinsics", c.extrinsics, "from boards to T_cam_lidar");
}

SceneResult observe_scene(StaticScene scene, const Rig& rig, const Chessboard& board,
                          const LidarCalibrationConfig& config) {
  SceneResult result;
  result.scene = std::move(scene);
  result.name = result.scene.name;
  BoardView view;
  view.name = result.name;
  result.lidar_image =
      draw_lidar_image(result.scene.points, kFocals_px[0]);  // shown where the camera sees no board
  result.refused = look_with_camera(result, rig, board, config, view);
  if (result.refused.empty()) result.refused = look_with_lidar(result, board, config, view);
  if (result.refused.empty()) result.view = std::move(view);
  return result;
}

LidarCalibration calibrate_lidar(const std::vector<fs::path>& logs, const Rig& rig, const Chessboard& board,
                                 const LidarCalibrationConfig& config,
                                 const std::function<void()>& progress) {
  LidarCalibration result;
  result.rig = rig;
  result.scenes = observe_all(logs, rig, board, config, progress);
  std::vector<BoardView> views;
  for (const SceneResult& scene : result.scenes) {
    if (scene.view) views.push_back(*scene.view);
    if (!scene.refused.empty()) spdlog::warn("{} is left out: {}", scene.name, scene.refused);
  }
  if (static_cast<int>(views.size()) < config.extrinsics.min_boards) {
    throw DataError("only " + std::to_string(views.size()) + " of " + std::to_string(logs.size()) +
                    " recordings are usable, " + std::to_string(config.extrinsics.min_boards) +
                    " are needed (10 or more are good)" + list_refused(result.scenes));
  }
  result.extrinsics = solve_extrinsics(board, views, rig.cam0.camera.intrinsics, config.extrinsics);
  result.rig.lidar0->T_camera_lidar = result.extrinsics.T_camera_lidar;
  result.advice =
      advise_poses(board, views, result.extrinsics, rig.cam0.camera.intrinsics, config.extrinsics);
  return result;
}

}  // namespace alight
