#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// A LiDAR return in the world at its own time. Made once per point (T_world_imu(t1) * T_imu_lidar *
/// p_lidar), used for every image that it falls into: METHOD step 2 split at the world frame.
struct WorldPoint {
  std::int64_t t_ns = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
};

/// A sparse depth map with the time of every pixel.
struct SparseDepth {
  cv::Mat depth_m;    ///< CV_32FC1, plane depth in metres, 0 = missing
  cv::Mat offset_us;  ///< CV_32SC1, t_point - t_image in microseconds; 0 where depth is missing

  static SparseDepth empty(cv::Size size);
  int count() const { return cv::countNonZero(depth_m); }
};

/// Depth limits of projection, metres along the optical axis.
struct DepthRange {
  double min_m = 0.5;
  double max_m = 250.0;
};

/// A point as an image sees it.
struct PixelPoint {
  std::int32_t pixel;      ///< row * width + column
  float depth_m;           ///< plane depth
  std::int32_t offset_us;  ///< t_point - t_image
};

/// Those points that fall into the image taken at `t_image_ns` (paper 3.1, step 3), in their order: pinhole, nearest pixel.
std::vector<PixelPoint> points_in_image(const std::vector<WorldPoint>& points,
                                        const Eigen::Isometry3d& T_camera_world,
                                        const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns,
                                        const DepthRange& range);

/// Puts them into a map: where several fall on a pixel the one closest in time to the image wins (the nearer one at equal
/// times). May be called repeatedly on the same `out`, of the image's size, to accumulate.
void add_points(const std::vector<PixelPoint>& points, SparseDepth& out);

/// Both in one. @returns points that fell into the image and range
int project_points(const std::vector<WorldPoint>& points, const Eigen::Isometry3d& T_camera_world,
                   const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns, const DepthRange& range,
                   SparseDepth& out);

/// Pixels whose rays, at plane depth `depth_m`, lie inside a LiDAR's circular field of view.
/// @returns CV_8UC1, 255 inside
cv::Mat lidar_fov_mask(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_camera_lidar,
                       double half_fov_rad, double depth_m);

}  // namespace alight
