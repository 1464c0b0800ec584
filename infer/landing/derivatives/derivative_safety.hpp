#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/site_selector.hpp"

namespace alight {

/// The paper's safe ground (3.3 step 3): slope and roughness of the image under their limits, specks of noise
/// forgiven, ground below obstacles taken out, eroded and dilated.
/// @param level_depth_m CV_32FC1 plane depth of a level camera, 0 = unknown. @returns CV_8UC1, 255 = safe
cv::Mat derivative_safe_mask(const Terrain& terrain, const cv::Mat& level_depth_m,
                             const PinholeIntrinsics& intrinsics, const SiteSelectionConfig& config);

}  // namespace alight
