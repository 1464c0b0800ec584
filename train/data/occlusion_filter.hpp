#pragma once

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// Which points of the ground truth are trusted. A point measured a second before the image may lie behind what the
/// image shows: the vehicle has moved, and saw it past the roof that hides it now.
struct OcclusionFilterConfig {
  int window_px = 0;           ///< side of the neighbourhood that may hide a point, odd; 0: off, the paper
  double min_offset_s = 0.25;  ///< points nearer in time to the image are always trusted
  double margin =
      0.03;  ///< share of its depth by which a hidden point lies behind the nearest of its neighbours
};
void bind(Binder& b, OcclusionFilterConfig& c);

/// Drops points that may be hidden. Points nearer in time stay, so that the ground beside an edge is not lost.
/// @param sparse_m [B,1,H,W] metres, 0 = missing @param offset_s [B,1,H,W] t_point - t_image @returns [B,1,H,W]
torch::Tensor drop_hidden_points(const torch::Tensor& sparse_m, const torch::Tensor& offset_s,
                                 const OcclusionFilterConfig& config);

}  // namespace alight
