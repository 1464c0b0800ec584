#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// A patch of one image found again in another.
struct PatchMatch {
  Eigen::Vector2d offset;       ///< found - expected, pixels
  double correlation = 0;       ///< where it was expected; 1 is alike
  double best_correlation = 0;  ///< where it was found
};

/// Searches the 11x11 patch around `at` within 14 px of where it is expected, to a fraction of a pixel (a parabola through the
/// normalised correlation). Empty where the patch has too little contrast, lies at an image's border, or is not found again.
/// @param from, to CV_8UC1
std::optional<PatchMatch> find_patch(const cv::Mat& from, const Eigen::Vector2d& at, const cv::Mat& to,
                                     const Eigen::Vector2d& expected);

/// How the pixel of a ray (z = 1) moves when what is seen turns about the camera's axes (rotation vector, rad).
Eigen::Matrix<double, 2, 3> pixel_by_turn(const Eigen::Vector3d& ray, const PinholeIntrinsics& intrinsics);

}  // namespace alight
