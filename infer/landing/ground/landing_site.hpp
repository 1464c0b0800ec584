#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "geometry/camera.hpp"

namespace alight {

/// A circle of safe ground, seen by the level camera.
struct LandingSite {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< in the level camera's image, perhaps outside it
  double radius_px = 0;
  double depth_m = 0;   ///< plane depth of the centre
  double radius_m = 0;  ///< safe ground around the centre; in pixels times depth / f
  Eigen::Vector3d p_level = Eigen::Vector3d::Zero();  ///< the centre in the level camera's frame
  /// The same in the world, if the camera's position was given; else from the camera, in the world's axes.
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  double slope_rad = 0;   ///< steepest on the circle
  double obstacle_m = 0;  ///< from the centre to the nearest thing that rises over it
  double distance_m = 0;  ///< horizontally from the camera
  double confidence = 1;  ///< mean over the circle, 0..1
  double score = 0;       ///< see SiteRankingConfig
};

/// Pixels per unit of length at unit depth, for radii: of the two focal lengths the longer one, which makes the smaller
/// circle.
inline double radius_focal_px(const PinholeIntrinsics& intrinsics) {
  return std::max(intrinsics.fx_px, intrinsics.fy_px);
}

}  // namespace alight
