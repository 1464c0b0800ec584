#include "geometry/projection.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace alight {
namespace {

/// Closer in time wins; at equal times the nearer surface.
bool wins(std::int64_t offset_us, float depth_m, std::int32_t held_offset_us, float held_depth_m) {
  if (held_depth_m == 0.0F) return true;
  const std::int64_t age = std::abs(offset_us);
  const std::int64_t held_age = std::abs(static_cast<std::int64_t>(held_offset_us));
  return age != held_age ? age < held_age : depth_m < held_depth_m;
}

}  // namespace

SparseDepth SparseDepth::empty(cv::Size size) {
  return {cv::Mat::zeros(size, CV_32FC1), cv::Mat::zeros(size, CV_32SC1)};
}

std::vector<PixelPoint> points_in_image(const std::vector<WorldPoint>& points,
                                        const Eigen::Isometry3d& T_camera_world,
                                        const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns,
                                        const DepthRange& range) {
  const Eigen::Matrix3d R = T_camera_world.linear();
  const Eigen::Vector3d t = T_camera_world.translation();
  std::vector<PixelPoint> inside;
  for (const WorldPoint& point : points) {
    const Eigen::Vector3d p_camera = R * point.p_world + t;
    if (!(p_camera.z() >= range.min_m && p_camera.z() <= range.max_m)) continue;
    const Eigen::Vector2d pixel = intrinsics.project(p_camera);
    if (!intrinsics.contains(pixel.x(), pixel.y())) continue;
    const std::int64_t offset_us = (point.t_ns - t_image_ns) / 1000;
    if (std::abs(offset_us) > std::numeric_limits<std::int32_t>::max()) continue;
    // The sum is never negative, so truncation is floor.
    const int u = static_cast<int>(pixel.x() + 0.5);
    const int v = static_cast<int>(pixel.y() + 0.5);
    inside.push_back({v * intrinsics.width_px + u, static_cast<float>(p_camera.z()),
                      static_cast<std::int32_t>(offset_us)});
  }
  return inside;
}

void add_points(const std::vector<PixelPoint>& points, SparseDepth& out) {
  CV_Assert(out.depth_m.isContinuous() && out.offset_us.isContinuous() &&
            out.depth_m.size() == out.offset_us.size());
  auto* const depths_m = out.depth_m.ptr<float>();
  auto* const offsets_us = out.offset_us.ptr<std::int32_t>();
  for (const PixelPoint& point : points) {
    float& held_depth_m = depths_m[point.pixel];
    std::int32_t& held_offset_us = offsets_us[point.pixel];
    if (!wins(point.offset_us, point.depth_m, held_offset_us, held_depth_m)) continue;
    held_depth_m = point.depth_m;
    held_offset_us = point.offset_us;
  }
}

int project_points(const std::vector<WorldPoint>& points, const Eigen::Isometry3d& T_camera_world,
                   const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns, const DepthRange& range,
                   SparseDepth& out) {
  CV_Assert(out.depth_m.size() == intrinsics.size());
  const std::vector<PixelPoint> inside =
      points_in_image(points, T_camera_world, intrinsics, t_image_ns, range);
  add_points(inside, out);
  return static_cast<int>(inside.size());
}

cv::Mat lidar_fov_mask(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_camera_lidar,
                       double half_fov_rad, double depth_m) {
  const Eigen::Isometry3d T_lidar_camera = T_camera_lidar.inverse();
  const double min_cosine = std::cos(half_fov_rad);
  const Eigen::Vector3d step = T_lidar_camera.linear().col(0) * (depth_m / intrinsics.fx_px);
  cv::Mat mask(intrinsics.size(), CV_8UC1);
  for (int v = 0; v < mask.rows; ++v) {
    const Eigen::Vector3d first = T_lidar_camera * (depth_m * intrinsics.ray(0, v));
    auto* const row = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) {
      const Eigen::Vector3d p_lidar = first + u * step;
      row[u] = p_lidar.x() >= min_cosine * p_lidar.norm() ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace alight
