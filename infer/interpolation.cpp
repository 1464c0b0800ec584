#include "infer/interpolation.hpp"

#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"

namespace alight {

void bind(Binder& b, InterpolationConfig& c) {
  b.field("max_distance_px", c.max_distance_px, "pixels farther from every point stay unknown; 0: no limit",
          between(0, 10000));
}

cv::Mat interpolate_inside_fov(const cv::Mat& sparse_m, const cv::Mat& fov,
                               const InterpolationConfig& config) {
  if (config.max_distance_px <= 0 || cv::countNonZero(sparse_m) == 0) return fill_nearest(sparse_m, fov);
  cv::Mat distance_px;
  cv::distanceTransform(sparse_m == 0, distance_px, cv::DIST_L2, cv::DIST_MASK_5);
  return fill_nearest(sparse_m, fov & (distance_px <= config.max_distance_px));
}

}  // namespace alight
