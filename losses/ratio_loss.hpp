#pragma once

#include <torch/torch.h>

namespace alight {

/// Depth ratio loss (paper 3.2, C_r): mean of |pred - gt| / gt over the pixels where target > 0; the same
/// error in metres counts more near the ground.
/// @param prediction_m [B,1,H,W] metres @param target_m [B,1,H,W] metres, 0 = missing @returns scalar, no
/// unit
torch::Tensor ratio_loss(const torch::Tensor& prediction_m, const torch::Tensor& target_m);

}  // namespace alight
