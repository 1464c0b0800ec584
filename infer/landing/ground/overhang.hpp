#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/ground/elevation_raster.hpp"

namespace alight {

/// The ground straight below obstacles. A wire, a branch or a pole's arm is seen beside the ground that it hangs over,
/// by height times the tangent of the viewing angle; a vehicle that descends there meets it all the same.
/// @param level_depth_m CV_32FC1 plane depth of a camera that looks straight down, 0 = unknown
/// @param obstacles CV_8UC1, the pixels whose columns are followed
/// @param clearance_m surfaces less far below are the obstacle's own foot
/// @returns CV_8UC1, 255 at pixels that show the surface below an obstacle
cv::Mat ground_beneath(const cv::Mat& level_depth_m, const cv::Mat& obstacles,
                       const PinholeIntrinsics& intrinsics, double clearance_m);

/// Cells over which nothing can hang unseen. A camera sees the ground 3 m aside from 10 m up, but not the crown over it:
/// the higher a point of the column, the farther out it lies in the image.
/// @param T_world_camera of the camera itself, tilted as it is
/// @param column_m height over the cell's mean that has to lie in the image (> 0)
/// @returns CV_8UC1 of the raster's size, 255 where the column up to there does; 0 where the cell is unknown
cv::Mat columns_in_view(const ElevationRaster& raster, const PinholeIntrinsics& intrinsics,
                        const Eigen::Isometry3d& T_world_camera, double column_m);

}  // namespace alight
