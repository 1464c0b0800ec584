#pragma once

#include <torch/torch.h>

namespace alight {

/// Structural similarity (Wang et al. 2004) over 3x3 windows of equal weight with reflection padding, C1 =
/// 0.01^2, C2 = 0.03^2 (METHOD, "Losses"): 1 for equal windows, down to -1.
/// @param a, b [B,C,H,W] in 0..1, H and W at least 2 @returns [B,C,H,W]
torch::Tensor ssim_map(const torch::Tensor& a, const torch::Tensor& b);

}  // namespace alight
