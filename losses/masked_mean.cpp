#include "losses/masked_mean.hpp"

#include <stdexcept>

namespace alight {

SampleMeans sample_means(const torch::Tensor& value, const torch::Tensor& mask) {
  if (value.dim() < 2 || value.sizes() != mask.sizes() || mask.scalar_type() != torch::kBool) {
    throw std::invalid_argument("sample_means: expected values [B,...] and a bool mask of their shape");
  }
  const torch::Tensor count = mask.flatten(1).sum(1);
  const torch::Tensor sum = torch::where(mask, value, torch::zeros_like(value)).flatten(1).sum(1);
  return {sum / count.clamp_min(1).to(value.dtype()), count > 0};
}

torch::Tensor mean_over_samples(const SampleMeans& means) {
  const torch::Tensor any = means.any.to(means.mean.dtype());
  return (means.mean * any).sum() / any.sum().clamp_min(1);
}

torch::Tensor masked_mean(const torch::Tensor& value, const torch::Tensor& mask) {
  return mean_over_samples(sample_means(value, mask));
}

torch::Tensor mean_or_zero(const torch::Tensor& value) {
  return value.numel() > 0 ? value.mean() : value.sum();
}

}  // namespace alight
