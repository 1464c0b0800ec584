#pragma once

#include <opencv2/core.hpp>

namespace alight {

/// What is linear inside a triangle. A plane in space has an inverse depth that is linear over the image; its depth is
/// so only where it faces the camera.
enum class LinearQuantity { kDepth, kInverseDepth };

/// Linear interpolation on the Delaunay triangulation of the points; outside their convex hull the nearest point's
/// depth. Without a point the result is 0 everywhere.
/// @param sparse_m CV_32FC1 plane depth, 0 = no point, up to 8192 pixels a side @returns CV_32FC1
cv::Mat fill_delaunay(const cv::Mat& sparse_m, LinearQuantity quantity = LinearQuantity::kDepth);

}  // namespace alight
