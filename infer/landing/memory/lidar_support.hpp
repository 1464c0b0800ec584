#pragma once

#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// The LiDAR points of one frame by the cells of a horizontal raster, aligned to the world as ElevationRaster is.
/// Heights are the world's z.
struct LidarReturns {
  std::int64_t first_column = 0;
  std::int64_t first_row = 0;
  cv::Mat count;          ///< CV_32FC1, points in the cell; the heights below are 0 where there is none
  cv::Mat mean_m;         ///< CV_32FC1
  cv::Mat top_m;          ///< CV_32FC1, the highest point
  cv::Mat bottom_m;       ///< CV_32FC1, the lowest point
  double within_fov = 0;  ///< points within the half angle of the optical axis

  /// Whether there are points in a cell of the world; then row and column say where in the maps.
  bool hit(std::int64_t world_column, std::int64_t world_row, int& column, int& row) const;
};

/// Sorts the points of a sparse depth map into cells.
/// @param sparse_m CV_32FC1 plane depth, 0 = no point
/// @param reach_m points farther away along either axis are left out of the cells, which bounds the maps
/// @param half_fov_deg which points count as within_fov
/// @throws std::invalid_argument
LidarReturns lidar_returns(const cv::Mat& sparse_m, const PinholeIntrinsics& intrinsics,
                           const Eigen::Isometry3d& T_world_camera, double cell_m, double reach_m,
                           double half_fov_deg);

}  // namespace alight
