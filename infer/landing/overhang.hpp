#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// The ground straight below obstacles. A wire, a branch or a pole's arm is seen beside the ground that it hangs over,
/// by height times the tangent of the viewing angle; a vehicle that descends there meets it all the same.
/// @param level_depth_m CV_32FC1 plane depth of a camera that looks straight down, 0 = unknown
/// @param obstacles CV_8UC1, the pixels whose columns are followed
/// @param clearance_m surfaces less far below are the obstacle's own foot
/// @returns CV_8UC1, 255 at pixels that show the surface below an obstacle
cv::Mat ground_beneath(const cv::Mat& level_depth_m, const cv::Mat& obstacles,
                       const PinholeIntrinsics& intrinsics, double clearance_m);

}  // namespace alight
