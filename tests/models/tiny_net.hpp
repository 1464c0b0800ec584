#pragma once

#include "models/depth_completion_net.hpp"

namespace alight::test {

/// The smallest network with all parts.
inline DepthCompletionConfig tiny_config() {
  DepthCompletionConfig config;
  config.image_widths = {4, 4, 8, 8};
  config.depth_widths = {4, 4, 8, 8};
  config.decoder_widths = {8, 4, 4, 4, 4};
  return config;
}

/// Depth of 5..25 m at about a fifth of the pixels. @returns [batch,1,height,width]
inline torch::Tensor random_sparse_m(std::int64_t batch, std::int64_t height, std::int64_t width) {
  const torch::Tensor depth_m = 5 + 20 * torch::rand({batch, 1, height, width});
  return depth_m * (torch::rand_like(depth_m) < 0.2).to(depth_m.dtype());
}

/// Both eyes, a height and a baseline.
inline SceneView random_view(std::int64_t batch, std::int64_t height, std::int64_t width) {
  SceneView view{torch::rand({batch, 3, height, width}), torch::rand({batch, 3, height, width})};
  view.prior_m = 5 + 20 * torch::rand({batch, 1, height, width});
  view.focal_baseline_px_m = torch::full({batch}, 35.0);
  return view;
}

}  // namespace alight::test
