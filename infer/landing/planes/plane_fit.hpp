#pragma once

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "infer/landing/ground/ground_map.hpp"

namespace alight {

/// Over which ground a plane is laid. Metres on the ground: the answer depends neither on the height of flight nor on
/// the size of a pixel.
struct PlaneFitConfig {
  double cell_m =
      0.2;  ///< side of a cell; higher up it grows with the pixels, so that cells do not stay empty
  double radius_m = 0.6;         ///< of the disc on which a cell's plane is fitted
  double max_residual_m = 0.07;  ///< nothing on the disc may lie farther above or below the plane
  /// 1 sigma of a single depth: what noise explains of the highest and lowest points is no residual. 0: depth is perfect.
  double noise_m = 0.02;
  double reach_m = 60;  ///< ground farther away horizontally is left out
};
void bind(Binder& b, PlaneFitConfig& c);

/// Least-squares plane through the cells' heights on a disc around every cell. The points of a cell do not lie evenly
/// around its middle, which on a slope is an error; so planes are fitted twice, the second time through the mean heights
/// moved to the cells' middles along the first ones. The part of a cell's own spread that the slope explains is taken
/// off the residual.
GroundShape fit_planes(const ElevationRaster& raster, const PlaneFitConfig& config);

}  // namespace alight
