#pragma once

#include <opencv2/core.hpp>

namespace alight {

/// Radius of the free circle around every pixel or cell: from its centre to the edge of the nearest unsafe one. Beyond the
/// map all is unsafe.
/// @param safe CV_8UC1, non-zero = safe
/// @param side length of a pixel's side; 1: radii are in pixels
/// @returns CV_32FC1 of the same size, 0 where unsafe
cv::Mat free_radius(const cv::Mat& safe, double side = 1);

}  // namespace alight
