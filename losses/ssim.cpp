#include "losses/ssim.hpp"

#include <stdexcept>

namespace alight {
namespace {

constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

/// Mean of every 3x3 window.
torch::Tensor window_mean(const torch::Tensor& padded) { return torch::avg_pool2d(padded, 3, 1); }

}  // namespace

torch::Tensor ssim_map(const torch::Tensor& a, const torch::Tensor& b) {
  if (a.dim() != 4 || a.sizes() != b.sizes() || a.size(2) < 2 || a.size(3) < 2) {
    throw std::invalid_argument("ssim_map: expected two images [B,C,H,W] of at least 2x2 pixels");
  }
  const torch::Tensor x = torch::reflection_pad2d(a, {1, 1, 1, 1});
  const torch::Tensor y = torch::reflection_pad2d(b, {1, 1, 1, 1});
  const torch::Tensor mean_x = window_mean(x);
  const torch::Tensor mean_y = window_mean(y);
  const torch::Tensor variance_x = window_mean(x * x) - mean_x * mean_x;
  const torch::Tensor variance_y = window_mean(y * y) - mean_y * mean_y;
  const torch::Tensor covariance = window_mean(x * y) - mean_x * mean_y;
  const torch::Tensor numerator = (2 * mean_x * mean_y + kC1) * (2 * covariance + kC2);
  const torch::Tensor denominator =
      (mean_x * mean_x + mean_y * mean_y + kC1) * (variance_x + variance_y + kC2);
  return numerator / denominator;
}

}  // namespace alight
