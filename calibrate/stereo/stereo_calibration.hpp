#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "calibrate/board/chessboard.hpp"
#include "foundation/binder_fwd.hpp"
#include "geometry/rig/rig.hpp"

namespace alight {

/// `alight-calibrate stereo`.
struct StereoCalibrationConfig {
  DistortionModel model = DistortionModel::kRadtan;
  int radtan_coefficients = 5;  ///< 4: k1 k2 p1 p2; 5: and k3
  double max_view_over_median =
      2.5;  ///< a view whose RMS is larger than so many times the median is left out ...
  double min_rejected_rms_px = 0.5;  ///< ... if it is also larger than this
  int min_views = 6;
  double min_coverage = 0.4;  ///< share of the image, in tenths each way, with corners; below it a warning
  int threads = 2;
};
void bind(Binder& b, StereoCalibrationConfig& c);

/// A pair of images of the board, from one exposure.
struct StereoView {
  std::string name;
  cv::Mat left;  ///< CV_8UC1
  cv::Mat right;
  Corners left_corners;  ///< empty: not found
  Corners right_corners;
  bool used = false;
  std::string reason;      ///< why not
  double rms_left_px = 0;  ///< reprojection error of the used view
  double rms_right_px = 0;
};

/// A parameter with its standard deviation.
struct Estimate {
  std::string name;
  double value = 0;
  double sigma = 0;
};

/// The outcome of a stereo calibration; errors in pixels.
struct StereoCalibration {
  Rig rig;            ///< both cameras, without topics, LiDAR and IMU
  double rms_px = 0;  ///< over all corners of both cameras, as cv::stereoCalibrate counts
  std::vector<Estimate> estimates;
  double epipolar_rms_px = 0;  ///< row of a corner in the left minus in the right rectified image
  double epipolar_max_px = 0;
  double coverage_left = 0;  ///< share of the image's tenths each way that hold a corner
  double coverage_right = 0;
  std::vector<StereoView> views;
};

/// Lenses and the right camera's place together, by Levenberg-Marquardt over all corners of both (Zhang, "A Flexible
/// New Technique for Camera Calibration", 2000; started by OpenCV). Views that fit far worse than the others are left out
/// with the reason, and the rest is calibrated anew.
/// @throws DataError too few views, or a camera that never saw the board
StereoCalibration calibrate_stereo(const Chessboard& board, std::vector<StereoView> views,
                                   const StereoCalibrationConfig& config);

}  // namespace alight
