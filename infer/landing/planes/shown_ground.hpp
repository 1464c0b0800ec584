#pragma once

#include <Eigen/Geometry>

#include "geometry/camera.hpp"
#include "infer/landing/ground/site_selection.hpp"

namespace alight {

/// The judged raster as the level camera sees it: every pixel of `terrain`, `safe` and `radius_m` shows its cell.
/// @param margin_m taken off every radius
/// @param out with level_depth_m and the judged ground; gets the maps, of the camera's size; nothing is safe where there
/// is no ground
void show_ground(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_level, double margin_m,
                 SiteSelection& out);

}  // namespace alight
