#pragma once

#include <torch/torch.h>

namespace alight {

/// `squared`: (pred - gt)^2 in m^2, the paper's C_d. `log`: |ln(pred / gt)|, no unit: an error of a metre at
/// 30 m, as in samples without LiDAR, then does not drown one of centimetres, and nothing diverges (METHOD,
/// "The opponent"). `rmse`: the root of a sample's mean squared error, metres: what the tables report, with gradients
/// that are alike for samples whose errors are metres and centimetres.
enum class DepthError { kSquared, kLog, kRmse };

/// Supervised depth loss (paper 3.2, C_d): mean error over the pixels where target > 0.
/// @param prediction_m [B,1,H,W] metres, positive @param target_m [B,1,H,W] metres, 0 = missing @returns
/// scalar
torch::Tensor depth_loss(const torch::Tensor& prediction_m, const torch::Tensor& target_m,
                         DepthError error = DepthError::kSquared);

}  // namespace alight
