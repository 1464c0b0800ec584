#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "infer/landing/ground/site_selection.hpp"

namespace alight {

/// One way to tell safe ground in a depth map (paper 3.3 steps 3 and 4). Free of state.
class GroundJudge {
 public:
  virtual ~GroundJudge() = default;

  /// What there is to judge. Nothing is decided: no safe ground, no site.
  /// @param depth_m CV_32FC1 plane depth of the camera as it is, 0 = unknown
  /// @param seen with R_level_camera and level_depth_m; gets what this way goes by
  virtual void look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                    SiteSelection& seen) const = 0;

  /// Safe ground and the circles on it: all maps, the largest circle and sites without their scores; kNoFlatArea at best.
  /// conclude() does the rest.
  /// @param hazards CV_8UC1 of the raster's size, non-zero = unsafe whatever it looks like; empty: none
  /// @param out as look() left it
  /// @throws std::invalid_argument if there are hazards and no raster of their size
  virtual void decide(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
                      SiteSelection& out) const = 0;

  /// How far beside unknown ground a verdict may come from the unknown alone.
  /// @param metres_per_pixel of the level image on the ground
  virtual double doubtful_border_m(double metres_per_pixel) const = 0;
};

}  // namespace alight
