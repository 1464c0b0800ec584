#include "losses/depth_loss.hpp"

#include <stdexcept>

#include "losses/masked_mean.hpp"

namespace alight {

torch::Tensor depth_loss(const torch::Tensor& prediction_m, const torch::Tensor& target_m, DepthError error) {
  if (prediction_m.dim() != 4 || prediction_m.size(1) != 1 || prediction_m.sizes() != target_m.sizes()) {
    throw std::invalid_argument("depth_loss: expected prediction and target [B,1,H,W]");
  }
  const torch::Tensor known = target_m > 0;
  if (error == DepthError::kSquared) return masked_mean((prediction_m - target_m).square(), known);
  const torch::Tensor safe_target = torch::where(known, target_m, torch::ones_like(target_m));
  return masked_mean((prediction_m / safe_target).log().abs(), known);
}

}  // namespace alight
