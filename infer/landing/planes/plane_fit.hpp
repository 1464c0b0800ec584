#pragma once

#include <opencv2/core.hpp>

#include "infer/landing/ground/ground_map.hpp"
#include "infer/landing/planes/plane_fit_config.hpp"

namespace alight {

/// Least-squares plane through the cells' heights on a disc around every cell. The points of a cell do not lie evenly
/// around its middle, which on a slope is an error; so planes are fitted twice, the second time through the mean heights
/// moved to the cells' middles along the first ones. The part of a cell's own spread that the slope explains is taken
/// off the residual.
GroundShape fit_planes(const ElevationRaster& raster, const PlaneFitConfig& config);

}  // namespace alight
