#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

/// Rules of other systems, restated from what they publish, to stand beside ours on the same depth maps.
namespace alight::bench {

/// PX4-Avoidance's safe_landing_planner (PX4/PX4-Avoidance, cfg/safe_landing_planner_node.cfg and README): cells of
/// 0.25 m; a cell may be landed on where the standard deviation of its heights is at most 0.2 m; of the 11 x 11 cells
/// around it more than 70 have to be such cells, and at most 70 may have a mean height that differs from its own by
/// more than 0.1 m. Differs: the original wants 100 points a cell and looks at 10 m x 10 m, which the images here cannot
/// fill from above 9 m; here three points are enough and the whole view counts. No slope, no history (alpha = 0).
/// @returns CV_8UC1 of the level camera, 255 = safe
cv::Mat px4_safe_mask(const cv::Mat& depth_m, const cv::Mat& level_depth_m,
                      const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                      const Eigen::Matrix3d& R_level_camera);

/// HALSS, the landing site selection of HALO (Hayner et al., ICRA 2023, arXiv:2304.01583): points interpolated to an
/// elevation raster, its surface normals compared with the vertical, the distance transform of what is flat gives
/// circles, the largest first, each cut out before the next. Safe is the ground inside the circles of at least
/// `min_radius_m`. Restated from its abstract and public summaries, not from the full text: cells of 0.2 m, normals by
/// central differences and 10 degrees are our choice, and its learned fine stage is left out.
/// @returns CV_8UC1 of the level camera, 255 = safe
cv::Mat halss_safe_mask(const cv::Mat& depth_m, const cv::Mat& level_depth_m,
                        const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                        const Eigen::Matrix3d& R_level_camera, double max_slope_deg, double min_radius_m);

}  // namespace alight::bench
