#pragma once

#include <opencv2/core.hpp>

namespace alight {

/// IP-Basic (Ku, Harakeh and Waslander, "In Defense of Classical Image Processing: Fast Depth Completion on the CPU",
/// 2018), with the kernels of the paper's best variant: depths are inverted so that dilation prefers near ones, dilated
/// with a 5x5 diamond, closed with 5x5, holes filled with 7x7, then with 31x31, smoothed by a 5x5 median and a 5x5
/// Gaussian, inverted back. The paper extends the topmost depth of a column to the image's upper edge, for a LiDAR that
/// does not see the sky; one that looks down leaves a rim all around, so what the 31x31 step does not reach takes the
/// nearest depth, in whatever direction that lies. Without a point the result is 0 everywhere.
/// @param sparse_m CV_32FC1 plane depth, 0 = no point
/// @param range_m depths are inverted as range_m - depth (100 m in the paper); raised where the map holds more
cv::Mat fill_ip_basic(const cv::Mat& sparse_m, double range_m = 100);

}  // namespace alight
