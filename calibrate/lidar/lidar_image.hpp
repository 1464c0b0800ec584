#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// The LiDAR's points drawn as an image on a virtual plane in front of it (paper 3.1). Frame `virtual`: at the LiDAR's
/// origin, optical axis along its boresight.
struct LidarImage {
  cv::Mat reflectivity;  ///< CV_8UC1
  cv::Mat seen;          ///< CV_8UC1, 255 where points fell; the rest is filled from the nearest such pixel
  PinholeIntrinsics intrinsics;

  /// Viewing ray of a pixel in the LiDAR's frame, unit length.
  Eigen::Vector3d ray(const cv::Point2f& pixel) const;
  /// Pixel of a point in the LiDAR's frame; it has to lie in front (x > 0).
  Eigen::Vector2d project(const Eigen::Vector3d& p_lidar) const;
};

/// Lidar optical axis along x: virtual x = right = -y, virtual y = down = -z, virtual z = x.
Eigen::Matrix3d R_virtual_lidar();

/// Mean reflectivity of the points of each pixel. A hole takes the value of the nearest pixel that has one: of two
/// equally dense sides of an edge neither grows. @param focal_px pixels a radian at the boresight
LidarImage draw_lidar_image(const std::vector<LidarReturn>& points, double focal_px);

}  // namespace alight
