#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "calibrate/board/chessboard.hpp"
#include "calibrate/fitting/rigid_motion.hpp"
#include "calibrate/lidar/board_fit.hpp"
#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"

namespace alight {

/// What is asked of a LiDAR-camera calibration.
struct ExtrinsicsConfig {
  double max_board_rmse_px = 2;  ///< boards that fit worse are left out
  int min_boards = 3;
  double min_tilt_spread_deg = 15;  ///< between the two most different boards
  double max_rotation_sigma_deg = 0.1;
  double max_translation_sigma_m = 0.01;
  double min_distinctness = 2;  ///< RMSE of the second best extrinsics over that of the best
  double range_bias_m = 0.01;   ///< 1 sigma of a LiDAR's systematic range error, and again of a board's own
  double angle_bias_deg =
      0.033;  ///< 1 sigma of its systematic direction error at a board: Livox promises 0.1
  double min_camera_noise_px = 0.03;  ///< 1 sigma: no corner is better known than this
};
void bind(Binder& b, ExtrinsicsConfig& c);

/// One board, seen by both sensors.
struct BoardView {
  std::string name;
  std::vector<Eigen::Vector2d> pixels;  ///< of the corners, free of distortion, in the camera's order
  bool camera_first_dark = false;       ///< whether the first square in the camera's order is
  LidarBoard lidar;                     ///< in the LiDAR's own order
  bool lidar_first_dark = false;
};

/// How a board came out.
struct BoardResult {
  std::string name;
  double rmse_px = 0;     ///< LiDAR corners reprojected into the camera, board where the LiDAR alone saw it
  double distance_m = 0;  ///< of the board's centre from the camera
  double tilt_deg = 0;    ///< between the board's normal and the ray to its centre
  bool used = true;
  std::string reason;  ///< why not
};

/// Extrinsics that also explain the boards, but worse.
struct Alternative {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  double rmse_px = 0;
};

/// Where the LiDAR sits before the left camera, how well that is known, and what else would explain the boards.
struct Extrinsics {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of (translation [m], rotation vector [rad]), both in the camera's frame: true T = (Exp(w) R, t + dt).
  Matrix6d covariance = Matrix6d::Zero();
  double rmse_px = 0;          ///< of all used corners
  double camera_noise_px = 0;  ///< 1 sigma a coordinate, by the camera's corners alone
  double excess = 1;  ///< root of chi square over its degrees of freedom; over 1 it widens the covariance
  double range_offset_m = 0;  ///< how much farther than the truth the LiDAR measures
  double range_offset_sigma_m = 0;
  double condition = 0;  ///< of the scaled information matrix: 1 is ideal
  std::vector<BoardResult> boards;
  std::vector<Alternative> alternatives;  ///< best first
  Vector6d sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// T_camera_lidar from boards that both sensors saw; no start value. Each board alone gives T_camera_lidar by a PnP for
/// each order that its corners could have; the one that most boards agree with is the start (RANSAC whose samples are
/// boards, all of them tried). Levenberg-Marquardt then moves the extrinsics, every board within what the LiDAR saw
/// of it, and the LiDAR's range offset together. Restarts from the other candidates find other minima.
/// @param intrinsics of the undistorted pixels
/// @throws DataError too few boards, all parallel, not observable, ambiguous: each with what to do
Extrinsics solve_extrinsics(const Chessboard& board, const std::vector<BoardView>& views,
                            const PinholeIntrinsics& intrinsics, const ExtrinsicsConfig& config);

/// A further board pose that would help, in words, and what it would bring.
struct Advice {
  std::string pose;
  double rotation_sigma_deg = 0;   ///< the largest, afterwards
  double translation_sigma_m = 0;  ///< the largest, afterwards
};

}  // namespace alight
