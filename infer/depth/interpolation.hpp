#pragma once

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/rig/stereo_rectification.hpp"

namespace alight {

/// The fallback that needs no network (paper 3.2, "Inference Strategy").
struct InterpolationConfig {
  /// Pixels farther from every point stay unknown: water and glass return nothing, and a bank drawn across a pond
  /// would look like the best place to land. 0: fill however far, as the paper does.
  double max_distance_px = 12;
};
void bind(Binder& b, InterpolationConfig& c);

/// Nearest-neighbour interpolation of the points inside the LiDAR's field of view; everything else stays unknown.
/// @param sparse_m CV_32FC1 plane depth, 0 = no point. @param fov CV_8UC1, 255 inside. @returns CV_32FC1, 0 = unknown
cv::Mat interpolate_inside_fov(const cv::Mat& sparse_m, const cv::Mat& fov,
                               const InterpolationConfig& config);

/// Where the LiDAR's circle lies in the image, at the middle of the depths of its points.
/// @param sparse_m CV_32FC1 plane depth, 0 = no point @returns CV_8UC1, 255 inside
cv::Mat lidar_circle(const cv::Mat& sparse_m, const RectifiedRig& rig, double half_fov_deg);

}  // namespace alight
