#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/lidar/board_fit.hpp"
#include "calibrate/lidar/extrinsics.hpp"
#include "calibrate/lidar/static_scene.hpp"
#include "geometry/rig/rig.hpp"

namespace alight {

/// `alight-calibrate lidar`.
struct LidarCalibrationConfig {
  StaticSceneConfig scene;
  double max_camera_motion_px = 0.5;  ///< of a corner between the recording's first and last third
  double max_lidar_motion_m = 0.01;   ///< of a corner between its halves
  int threads = 2;
  ExtrinsicsConfig extrinsics;
};
void bind(Binder& b, LidarCalibrationConfig& c);

/// One recording after everything that needs no other recording.
struct SceneResult {
  std::string name;
  StaticScene scene;
  LidarImage lidar_image;
  std::optional<Corners> camera_corners;  ///< in the raw image
  std::optional<Corners> lidar_corners;   ///< in the LiDAR's image
  std::optional<BoardView> view;          ///< where all went well
  std::string refused;                    ///< why not
};

/// The board in one recording: found to be still, seen by both sensors. A bad scene is a result with the reason.
SceneResult observe_scene(StaticScene scene, const Rig& rig, const Chessboard& board,
                          const LidarCalibrationConfig& config);

/// The outcome of a calibration, board by board.
struct LidarCalibration {
  Rig rig;  ///< with the new T_cam_lidar
  Extrinsics extrinsics;
  std::vector<Advice> advice;
  std::vector<SceneResult> scenes;  ///< in the order of the logs
};

/// METHOD, "LiDAR-camera calibration", over all recordings. The same logs give the same rig for any number of threads.
/// @param progress called after each recording
/// @throws DataError that names every refused recording where too few are left, or what solve_extrinsics says
LidarCalibration calibrate_lidar(const std::vector<std::filesystem::path>& logs, const Rig& rig,
                                 const Chessboard& board, const LidarCalibrationConfig& config,
                                 const std::function<void()>& progress = {});

}  // namespace alight
