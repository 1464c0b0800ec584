#pragma once

#include <torch/torch.h>

namespace alight {

/// What the network sees of a moment before any LiDAR point has come. Only `left` is always needed.
struct SceneView {
  torch::Tensor left;     ///< [B,3,H,W] float32, RGB in 0..1; zeros: the camera is lost
  torch::Tensor right{};  ///< [B,3,H,W] the rectified right image; zeros or undefined: none
  /// [B,1,H,W] metres, level ground at the height that the vehicle reports (models/inputs/altitude_plane.hpp), of the
  /// network's depth kind; 0 or undefined: the height is unknown.
  torch::Tensor prior_m{};
  /// [B] focal length * baseline: disparity_px = this / depth_m; 0 or undefined: mono.
  torch::Tensor focal_baseline_px_m{};
};

}  // namespace alight
