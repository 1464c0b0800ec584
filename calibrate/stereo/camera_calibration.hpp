#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "calibrate/board/chessboard.hpp"
#include "calibrate/stereo/stereo_calibration.hpp"
#include "geometry/camera.hpp"

namespace alight {

/// One camera and where it saw the board.
struct CameraStart {
  Camera camera;
  std::vector<Eigen::Isometry3d> T_camera_board;  ///< of each view
};

/// One camera alone, the start of calibrate_stereo: by OpenCV, or of a fisheye its focal length and the poses, without
/// distortion. @param corners of each view. @throws DataError: no fisheye fits
CameraStart calibrate_camera(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size,
                             const StereoCalibrationConfig& config);

}  // namespace alight
