#pragma once

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"
#include "infer/landing/ground/terrain.hpp"

namespace alight {

/// Over which distances the ground's derivatives are taken.
struct TerrainConfig {
  /// Distance between the points that a derivative compares. The paper differences neighbouring pixels; at 30 m and
  /// 440 px these are 6.8 cm apart, where 2 cm of LiDAR noise alone is 16 degrees. A fixed distance on the ground
  /// makes the answer the same at every height. Steps lower than derivative_baseline_m * tan(max_roughness), 9 cm, and
  /// bumps half as high pass.
  double derivative_baseline_m = 0.5;
  /// Side of the square that heights are averaged over first, against point noise.
  int smoothing_px = 5;
};
void bind(Binder& b, TerrainConfig& c);

/// Slope and roughness (paper 3.3 step 3). Exact on planes of any tilt: distances on the ground come from the points
/// themselves, and smoothing averages 1/z, which a plane makes linear in the image. Where the ground folds over
/// itself (a wall seen from above) both are 90 degrees.
/// @param level_depth_m CV_32FC1 plane depth of a camera whose optical axis points down, 0 = unknown
Terrain measure_terrain(const cv::Mat& level_depth_m, const PinholeIntrinsics& intrinsics,
                        const TerrainConfig& config);

}  // namespace alight
