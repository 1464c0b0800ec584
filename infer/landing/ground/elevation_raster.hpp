#pragma once

#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// Heights on a horizontal raster whose cells are aligned to the world: cell (row, column) of the maps covers
/// [(first_column + column) cell_m, ... + cell_m) east and [(first_row + row) cell_m, ...) north. Heights are the
/// world's z. A cell holds everything that was seen over its square, so the ground under a branch or a wire is in one
/// cell with it.
struct ElevationRaster {
  double cell_m = 0;
  std::int64_t first_column = 0;
  std::int64_t first_row = 0;
  cv::Mat mean_m;    ///< CV_32FC1, 0 where unknown
  cv::Mat top_m;     ///< CV_32FC1, the highest point as far as noise does not explain it, as above
  cv::Mat bottom_m;  ///< CV_32FC1, the lowest point
  cv::Mat east_m;    ///< CV_32FC1, mean position of the points, from the cell's centre
  cv::Mat north_m;   ///< CV_32FC1, likewise
  cv::Mat known;     ///< CV_8UC1, 255 where at least one point fell
  cv::Mat
      column_seen{};  ///< CV_8UC1, 255 where the air over the cell is in view (columns_in_view); empty: not asked

  bool empty() const { return known.empty(); }
  cv::Size size() const { return known.size(); }
  /// East and north of a cell's centre.
  Eigen::Vector2d centre_m(int column, int row) const {
    return {(static_cast<double>(first_column + column) + 0.5) * cell_m,
            (static_cast<double>(first_row + row) + 0.5) * cell_m};
  }
  /// The cell over a place of the world; false outside the raster.
  bool cell_at(double x_m, double y_m, int& column, int& row) const;
};

/// Every known pixel of a depth map as a point of the raster.
/// @param depth_m CV_32FC1 plane depth of the camera, 0 = unknown
/// @param reach_m points farther away horizontally are left out, which bounds the raster
/// @param noise_m 1 sigma of a single depth. Tops and bottoms are then the larger of what a single point and what the mean
/// over 0.2 m around it say, each less 2.5 of its own sigmas, and never inside the mean.
/// @returns an empty raster if there is no point. @throws std::invalid_argument
ElevationRaster rasterize(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics,
                          const Eigen::Isometry3d& T_world_camera, double cell_m, double reach_m,
                          double noise_m = 0);

}  // namespace alight
