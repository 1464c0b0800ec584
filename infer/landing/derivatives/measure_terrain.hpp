#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/derivatives/derivatives_config.hpp"
#include "infer/landing/ground/terrain.hpp"

namespace alight {

/// Slope and roughness (paper 3.3 step 3). Exact on planes of any tilt: distances on the ground come from the points
/// themselves, and smoothing averages 1/z, which a plane makes linear in the image. Where the ground folds over
/// itself (a wall seen from above) both are 90 degrees.
/// @param level_depth_m CV_32FC1 plane depth of a camera whose optical axis points down, 0 = unknown
Terrain measure_terrain(const cv::Mat& level_depth_m, const PinholeIntrinsics& intrinsics,
                        const DerivativesConfig& config);

}  // namespace alight
