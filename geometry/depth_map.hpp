#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// What a depth value is measured along: `plane` the optical axis (z), `perspective` the viewing ray (range).
enum class DepthKind { kPlane, kPerspective };

/// Length of each pixel's viewing ray at plane depth 1: perspective = plane * ray_lengths. CV_32FC1
cv::Mat ray_lengths(const PinholeIntrinsics& intrinsics);

/// METHOD, "Depth"; paper 3.3 step 1. Depth CV_32FC1 in metres, 0 = missing stays 0.
cv::Mat plane_to_perspective(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics);
cv::Mat perspective_to_plane(const cv::Mat& range_m, const PinholeIntrinsics& intrinsics);

/// Nearest-neighbour interpolation: every pixel of `region` (CV_8UC1; empty: all) takes the depth of the
/// nearest pixel (Euclidean) that has one and is no farther than `max_distance_px`; elsewhere it is 0. A map without any
/// depth stays empty.
cv::Mat fill_nearest(const cv::Mat& depth_m, const cv::Mat& region = {},
                     double max_distance_px = std::numeric_limits<double>::infinity());

/// The depths that are known (greater than 0), row by row. @param depth_m CV_32FC1
std::vector<float> known_depths(const cv::Mat& depth_m);

/// Median of the known depths; empty where there is none. @param depth_m CV_32FC1, 0 = unknown
std::optional<double> median_depth_m(const cv::Mat& depth_m);

/// From the 1st to the 99th percentile of the known depths and no narrower than 10 cm; 0 to 1 m where there is none.
struct ColourRange {
  double min_m = 0;
  double max_m = 1;
};
ColourRange colour_range(const cv::Mat& depth_m);

/// Depth as colours (turbo, near = red, far = blue), BGR CV_8UC3; missing is black. With max_m <= min_m the
/// range is the map's own, `colour_range`.
cv::Mat colour_depth(const cv::Mat& depth_m, double min_m = 0, double max_m = 0);

/// 16-bit in 1/256 m, 0 = missing (KITTI's convention); values over 255.99 m saturate. And back.
cv::Mat encode_depth(const cv::Mat& depth_m);
cv::Mat decode_depth(const cv::Mat& depth_16);

}  // namespace alight
