#include "infer/depth/interpolation.hpp"

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

cv::Mat lidar_circle(const cv::Mat& sparse_m, const RectifiedRig& rig, double half_fov_deg) {
  constexpr double kUsualHeight_m = 20.0;
  return lidar_fov_mask(rig.intrinsics, rig.T_camera_lidar, to_radians(half_fov_deg),
                        median_depth_m(sparse_m).value_or(kUsualHeight_m));
}

}  // namespace alight
