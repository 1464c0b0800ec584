#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/derivatives/derivatives_config.hpp"
#include "infer/landing/ground/terrain.hpp"

namespace alight {

/// The paper's safe ground (3.3 step 3): slope and roughness of the image under their limits, specks of noise
/// forgiven, ground below obstacles taken out, eroded and dilated.
/// @param terrain of measure_terrain on the same depth
/// @param level_depth_m CV_32FC1 plane depth of a level camera, 0 = unknown
/// @returns CV_8UC1 of the image's size, 255 = safe
cv::Mat derivative_safe_mask(const Terrain& terrain, const cv::Mat& level_depth_m,
                             const PinholeIntrinsics& intrinsics, const DerivativesConfig& config,
                             double max_slope_rad);

}  // namespace alight
