#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "foundation/binder_fwd.hpp"
#include "geometry/rig/rig.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {

/// A printed chessboard. Frame `board`: origin at the first inner corner, x along the columns, y along the rows, z into
/// the board, as a camera in front of it sees it (OpenCV's convention).
struct PrintedBoard {
  int columns = 6;  ///< inner corners along x
  int rows = 4;     ///< and along y
  double square_m = 0.12;
  double margin_m = 0.06;  ///< white, around the squares
};
void bind(Binder& b, PrintedBoard& c);

enum class Mounting { kAsRig, kRandom };

/// Recordings of a board in front of a rig that stands still.
struct BoardSceneConfig {
  BoardSceneConfig();

  std::string rig = "configs/rigs/paper.yaml";
  /// Random: the LiDAR turned about its boresight by a multiple of 90 deg and up to 10 deg more, tilted by up to 4 deg
  /// about each other axis, moved by up to 0.15 m an axis.
  Mounting mounting = Mounting::kAsRig;
  std::int64_t seed = 1;  ///< of mounting, poses, noise, and which LiDAR it is
  PrintedBoard board;
  int scenes = 12;
  double duration_s = 3;  ///< of each scene
  double min_distance_m = 3;
  double max_distance_m = 6;
  double max_tilt_deg = 35;   ///< of the board against facing the camera
  double max_roll_deg = 180;  ///< of the board about its normal
  double lens_blur_px = 0.6;  ///< 1 sigma of the lens's point spread
  double range_bias_m =
      0.004;  ///< 1 sigma of a systematic range error of all scenes, and again of one of each scene
  double drift_mps = 0;  ///< the rig moves: no scene for a calibration
  SensorsConfig sensors;
  RendererConfig renderer;
};
void bind(Binder& b, BoardSceneConfig& c);

/// The rig with the LiDAR as it is truly mounted. @throws ConfigError as flyable_rig
Rig mounted_rig(const BoardSceneConfig& config);

/// Where the board stands in each scene: wholly inside the LiDAR's field of view and the image.
/// @returns T_camera_board of each. @throws ConfigError if no such place is found
std::vector<Eigen::Isometry3d> board_poses(const BoardSceneConfig& config, const RectifiedRig& rig);

/// The board over level grass at z = 0.
World board_world(const PrintedBoard& board, const Eigen::Isometry3d& T_world_board);

}  // namespace alight::sim
