#pragma once

#include <opencv2/core.hpp>

#include "infer/landing/ground/elevation_raster.hpp"

namespace alight {

/// Shape of the ground around every cell of a raster, by a plane on a disc around it (fit_planes).
struct GroundShape {
  cv::Mat gradient;     ///< CV_32FC1, tangent of the plane's slope
  cv::Mat residual_m;   ///< CV_32FC1, largest vertical distance of anything on the disc to the plane
  cv::Mat deviation_m;  ///< CV_32FC1, the same of what is in the cell alone: an obstacle stands here
  cv::Mat plane_m;      ///< CV_32FC1, height of the plane at the cell's middle
  cv::Mat centre_m;     ///< CV_32FC1, mean height moved along the plane from the points' middle to the cell's
  cv::Mat known;        ///< CV_8UC1, 255 where every cell of the disc is known; elsewhere the others are 0
};

/// A raster that has been judged (judge_ground). All maps have the raster's size.
struct GroundMap {
  ElevationRaster raster;
  GroundShape shape;
  cv::Mat safe;  ///< CV_8UC1, 255 = safe
  cv::Mat
      radius_m;  ///< CV_32FC1, from a safe cell's centre to the nearest unsafe cell's edge; 0 where unsafe

  bool empty() const { return raster.empty(); }
};

}  // namespace alight
