#include "losses/ratio_loss.hpp"

#include <stdexcept>

#include "losses/masked_mean.hpp"

namespace alight {

torch::Tensor ratio_loss(const torch::Tensor& prediction_m, const torch::Tensor& target_m) {
  if (prediction_m.dim() != 4 || prediction_m.size(1) != 1 || prediction_m.sizes() != target_m.sizes()) {
    throw std::invalid_argument("ratio_loss: expected prediction and target [B,1,H,W]");
  }
  const torch::Tensor known = target_m > 0;
  const torch::Tensor safe_target = torch::where(known, target_m, torch::ones_like(target_m));
  return masked_mean((prediction_m - target_m).abs() / safe_target, known);
}

}  // namespace alight
