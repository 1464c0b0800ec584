#pragma once

#include <opencv2/core.hpp>

namespace alight {

/// Luminance in [0, 1] as CV_32FC1, of CV_8UC1 grey or CV_8UC3 BGR. @throws std::invalid_argument on other types
cv::Mat to_luminance(const cv::Mat& image);

/// Structural similarity per pixel: 3x3 box windows, reflection at the border, C1 = 0.01^2, C2 = 0.03^2 (METHOD,
/// "Losses"; Wang et al. 2004). @param a, b CV_32FC1 in [0, 1], same size. @returns CV_32FC1 in [-1, 1]
cv::Mat ssim_map(const cv::Mat& a, const cv::Mat& b);

}  // namespace alight
