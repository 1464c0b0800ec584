#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "calibrate/lidar/extrinsics.hpp"

namespace alight {

/// A board in the joint refinement: `turn` maps the camera's order of corners to the LiDAR's (board_turns).
struct JointBoard {
  const BoardView* view;
  Eigen::Isometry3d turn;
};

/// What is known beforehand, 1 sigma.
struct JointNoise {
  double camera_px = 0;
  double range_bias_m = 0;    ///< of all boards, and again of each
  double angle_bias_rad = 0;  ///< of each board: all of it appears turned about the LiDAR
};

/// The outcome of the joint refinement: transform, residuals, covariance.
struct JointResult {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< as Extrinsics::covariance
  double camera_noise_px = 0;
  double excess = 1;
  double range_offset_m = 0;
  double range_offset_sigma_m = 0;
  double condition = 0;
};

/// Minimises over the extrinsics, the LiDAR's range offset, and for each board its pose and own range offset:
/// reprojection errors of the corners over the camera's noise, boards against what the LiDAR saw of them, offsets
/// against their expected size.
JointResult refine_jointly(const Chessboard& board, const std::vector<JointBoard>& boards,
                           const PinholeIntrinsics& intrinsics, const JointNoise& noise,
                           const Eigen::Isometry3d& T_camera_lidar);

/// What one more board, alone, tells of (translation, rotation) of the extrinsics: the inverse of the covariance; none where
/// it leaves a direction free.
Matrix6d board_information(const Chessboard& board, const BoardView& view,
                           const Eigen::Isometry3d& T_camera_lidar, const PinholeIntrinsics& intrinsics,
                           const JointNoise& noise);

}  // namespace alight
