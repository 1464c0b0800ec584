#include "losses/depth_loss.hpp"

#include <cmath>
#include <stdexcept>

#include "losses/masked_mean.hpp"

namespace alight {
namespace {

constexpr double kRoundOff_m2 = 1e-6;  // the root has a gradient at 0, too

}  // namespace

torch::Tensor depth_loss(const torch::Tensor& prediction_m, const torch::Tensor& target_m, DepthError error) {
  if (prediction_m.dim() != 4 || prediction_m.size(1) != 1 || prediction_m.sizes() != target_m.sizes()) {
    throw std::invalid_argument("depth_loss: expected prediction and target [B,1,H,W]");
  }
  const torch::Tensor known = target_m > 0;
  if (error != DepthError::kLog) {
    SampleMeans square = sample_means((prediction_m - target_m).square(), known);
    if (error == DepthError::kRmse)
      square.mean = (square.mean + kRoundOff_m2).sqrt() - std::sqrt(kRoundOff_m2);
    return mean_over_samples(square);
  }
  const torch::Tensor safe_target = torch::where(known, target_m, torch::ones_like(target_m));
  return masked_mean((prediction_m / safe_target).log().abs(), known);
}

}  // namespace alight
