#pragma once

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "infer/landing/ground/ground_map.hpp"
#include "infer/landing/planes/plane_fit.hpp"

namespace alight {

/// What makes a cell of the ground unsafe besides its own slope and residual.
struct GroundSafetyConfig {
  /// Flat cells nearer to a hazard are given up: slope and residual are known to a cell's width only. The unknown needs
  /// no guard of its own, the disc keeps away from it already.
  double guard_m = 0.4;
  /// Level ground whose seen border falls away by more than this is a roof, a container or the like. 0: off.
  double platform_height_m = 1.0;
  double platform_border = 0.3;  ///< share of the border that has to fall away
};
void bind(Binder& b, GroundSafetyConfig& c);

/// Judges every cell by its shape (fit_planes of the same raster): the plane is less steep than the limit, nothing on the disc is farther from it than
/// plane_fit.max_residual_m, every cell of the disc is known, it is no raised platform, no cell that fails in
/// this lies within guard_m, and the air over it is in view where the raster asks for that. What is unknown and what lies beyond the raster is unsafe.
/// @param hazards CV_8UC1 of the raster's size, non-zero = unsafe whatever the shape says; may be empty
GroundMap judge_ground(ElevationRaster raster, GroundShape shape, const cv::Mat& hazards,
                       const PlaneFitConfig& plane_fit, const GroundSafetyConfig& safety,
                       double max_slope_rad);

}  // namespace alight
