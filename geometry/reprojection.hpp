#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// The source view's depth seen from the target camera: every pixel becomes a point, goes to the target and
/// the nearest surface wins (z-buffer, nearest pixel). Pixels that nobody lands on are 0.
/// @param depth_source_m CV_32FC1 plane depth, 0 = missing. @returns CV_32FC1 of intrinsics_target's size
cv::Mat reproject_depth(const cv::Mat& depth_source_m, const PinholeIntrinsics& intrinsics_source,
                        const Eigen::Isometry3d& T_target_source, const PinholeIntrinsics& intrinsics_target);

/// An image sampled from another view.
struct SampledView {
  cv::Mat image;  ///< type of the source image
  cv::Mat valid;  ///< CV_8UC1, 255 where depth is known and the pixel lands inside the source
};

/// Reconstructs the target image from the source image and the *target's* depth (bilinear, inverse warp).
SampledView sample_view(const cv::Mat& image_source, const PinholeIntrinsics& intrinsics_source,
                        const cv::Mat& depth_target_m, const PinholeIntrinsics& intrinsics_target,
                        const Eigen::Isometry3d& T_source_target);

/// Plane depth seen by a camera at the same place turned by R_target_source (paper 3.3 step 2: roll and pitch
/// to zero). A pure turn hides nothing, so this is an inverse warp without holes; nearest source pixel,
/// because a blend over a depth edge is a surface that does not exist.
cv::Mat rotate_depth(const cv::Mat& depth_source_m, const PinholeIntrinsics& intrinsics,
                     const Eigen::Matrix3d& R_target_source);

/// The level twin of a down-looking camera: optical axis along world down, yaw kept. @returns R_level_camera
Eigen::Matrix3d level_rotation(const Eigen::Matrix3d& R_world_camera);

/// Where that twin is: in the camera's place, turned level. @returns T_world_level
Eigen::Isometry3d level_pose(const Eigen::Isometry3d& T_world_camera, const Eigen::Matrix3d& R_level_camera);

}  // namespace alight
