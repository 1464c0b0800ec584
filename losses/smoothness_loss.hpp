#pragma once

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// How edges of the image excuse steps of depth (paper 3.2).
struct SmoothnessLossConfig {
  bool edge_aware = false;     ///< weigh with exp(-edge_sharpness * |image gradient|); off in the paper
  double edge_sharpness = 10;  ///< of images in 0..1
  bool relative = false;  ///< of ln(depth) in place of depth: the same at all altitudes; off in the paper
};
void bind(Binder& b, SmoothnessLossConfig& c);

/// Smoothness loss (paper 3.2, C_s): L1 norm of the gradient plus that of the Hessian, both in metres a
/// pixel, each entry a mean over the pixels that have it: |dx| + |dy| + |dxx| + 2 |dxy| + |dyy|, by forward
/// differences.
/// @param depth_m [B,1,H,W] @param image [B,3,H,W] in 0..1, read only if edge_aware @returns scalar
torch::Tensor smoothness_loss(const torch::Tensor& depth_m, const torch::Tensor& image,
                              const SmoothnessLossConfig& config = {});

}  // namespace alight
