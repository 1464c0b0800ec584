#include "infer/depth/interpolation.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "foundation/config_reader.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "geometry/projection.hpp"

namespace alight {

void bind(Binder& b, InterpolationConfig& c) {
  b.field("max_distance_px", c.max_distance_px, "pixels farther from every point stay unknown; 0: no limit",
          between(0, 10000));
}

cv::Mat interpolate_inside_fov(const cv::Mat& sparse_m, const cv::Mat& fov,
                               const InterpolationConfig& config) {
  if (config.max_distance_px <= 0) return fill_nearest(sparse_m, fov);
  return fill_nearest(sparse_m, fov, config.max_distance_px);
}

double median_depth_m(const cv::Mat& depth_m, double otherwise) {
  std::vector<float> values;
  for (int v = 0; v < depth_m.rows; ++v) {
    std::copy_if(depth_m.ptr<float>(v), depth_m.ptr<float>(v) + depth_m.cols, std::back_inserter(values),
                 [](float depth) { return depth > 0; });
  }
  if (values.empty()) return otherwise;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

cv::Mat lidar_circle(const cv::Mat& sparse_m, const RectifiedRig& rig, double half_fov_deg) {
  constexpr double kUsualHeight_m = 20.0;
  return lidar_fov_mask(rig.intrinsics, rig.T_camera_lidar, to_radians(half_fov_deg),
                        median_depth_m(sparse_m, kUsualHeight_m));
}

}  // namespace alight
