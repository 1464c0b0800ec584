#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "calibrate/board/chessboard.hpp"
#include "geometry/camera.hpp"

namespace alight {

/// What stereo calibration estimates.
struct StereoBundle {
  Camera left;
  Camera right;
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Isometry3d> T_left_board;  ///< a view
};

/// The corners of one view in both cameras.
struct StereoCorners {
  const Corners* left;
  const Corners* right;
};

/// Squared reprojection errors of a view, left and right, summed over its corners.
struct ViewError {
  double left = 0;
  double right = 0;
};

/// The outcome of a bundle adjustment; errors in pixels.
struct BundleResult {
  StereoBundle bundle;
  std::vector<ViewError> errors;  ///< a view
  /// 1 sigma of the shared parameters: left fx fy cx cy distortion, right likewise, T_right_left (translation m,
  /// rotation vector rad in the right camera's frame).
  Eigen::VectorXd sigma;
};

/// Least squares over everything at once (ceres::Solve); the noise is the residuals' own.
/// @throws DataError the views leave a parameter free
BundleResult refine_stereo(const Chessboard& board, const std::vector<StereoCorners>& corners,
                           const StereoBundle& start);

/// Pixels of all corners through a lens.
Corners project_board(const Chessboard& board, const Camera& camera, const Eigen::Isometry3d& T_camera_board);

}  // namespace alight
