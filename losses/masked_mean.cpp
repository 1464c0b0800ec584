#include "losses/masked_mean.hpp"

#include <stdexcept>

namespace alight {

torch::Tensor masked_mean(const torch::Tensor& value, const torch::Tensor& mask) {
  if (value.sizes() != mask.sizes() || mask.scalar_type() != torch::kBool) {
    throw std::invalid_argument("masked_mean: expected a bool mask of the value's shape");
  }
  return torch::where(mask, value, torch::zeros_like(value)).sum() /
         mask.sum().clamp_min(1).to(value.dtype());
}

torch::Tensor mean_or_zero(const torch::Tensor& value) {
  return value.numel() > 0 ? value.mean() : value.sum();
}

}  // namespace alight
