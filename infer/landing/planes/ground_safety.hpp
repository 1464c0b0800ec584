#pragma once

#include <opencv2/core.hpp>

#include "infer/landing/ground/ground_map.hpp"
#include "infer/landing/planes/plane_fit_config.hpp"

namespace alight {

/// Judges every cell by its shape (fit_planes of the same raster): the plane is less steep than the limit, nothing on the disc is farther from it than
/// max_residual_m, every cell of the disc is known, it is no raised platform, no cell that fails in
/// this lies within guard_m, and the air over it is in view where the raster asks for that. What is unknown and what lies beyond the raster is unsafe.
/// @param hazards CV_8UC1 of the raster's size, non-zero = unsafe whatever the shape says; empty: none
/// @throws std::invalid_argument if the hazards have another size or type
GroundMap judge_ground(ElevationRaster raster, GroundShape shape, const cv::Mat& hazards,
                       const PlaneFitConfig& config, double max_slope_rad);

}  // namespace alight
