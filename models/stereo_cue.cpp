#include "models/stereo_cue.hpp"

#include <stdexcept>
#include <vector>

#include "models/box_mean.hpp"

namespace alight {
namespace {

namespace F = torch::nn::functional;
constexpr int kScales = 3;
constexpr std::int64_t kWindow_px = 9;
constexpr std::int64_t kLocalMean_px = 15;  // eyes differ in brightness; what is left of it is no parallax
/// Variance of the noise in a window's mean product over that of ln(depth / prior) on real ground: the ridge term.
constexpr double kRidge = 1e-4;
constexpr double kLargestCue = 1.5;

torch::Tensor grey(const torch::Tensor& image) { return image.mean(1, /*keepdim=*/true); }

/// Central difference along rows, 0 at the border.
torch::Tensor horizontal_gradient(const torch::Tensor& x) {
  const std::int64_t width = x.size(3);
  const torch::Tensor inner = 0.5 * (x.slice(3, 2, width) - x.slice(3, 0, width - 2));
  return torch::constant_pad_nd(inner, {1, 1, 0, 0}, 0);
}

struct WarpedRight {
  torch::Tensor image;  // [B,1,H,W]
  torch::Tensor valid;  // [B,1,H,W], 1 where the pixel lies inside the right image
};

/// right(u - disparity, v)
WarpedRight warp(const torch::Tensor& right, const torch::Tensor& disparity_px) {
  const std::int64_t height = right.size(2);
  const std::int64_t width = right.size(3);
  const torch::Tensor u = torch::arange(width, right.options()).view({1, 1, -1}) - disparity_px.squeeze(1);
  const torch::Tensor v = torch::arange(height, right.options()).view({1, -1, 1}).expand_as(u);
  const torch::Tensor grid = torch::stack(
      {u * (2.0 / static_cast<double>(width - 1)) - 1.0, v * (2.0 / static_cast<double>(height - 1)) - 1.0},
      3);
  const auto options =
      F::GridSampleFuncOptions().mode(torch::kBilinear).padding_mode(torch::kBorder).align_corners(true);
  return {F::grid_sample(right, grid, options), (u >= 0).unsqueeze(1).to(right.dtype())};
}

/// Estimate and weight at one scale. @param disparity_px in pixels of this scale
std::vector<torch::Tensor> cue_at_scale(const torch::Tensor& left, const torch::Tensor& warped,
                                        const torch::Tensor& valid, const torch::Tensor& disparity_px) {
  const torch::Tensor a = left - box_mean(left, kLocalMean_px);
  const torch::Tensor b = warped - box_mean(warped, kLocalMean_px);
  const torch::Tensor slope = 0.5 * (horizontal_gradient(a) + horizontal_gradient(b)) * valid;
  const torch::Tensor slope_square = box_mean(slope * slope, kWindow_px);
  const torch::Tensor slope_change = box_mean(slope * (b - a) * valid, kWindow_px);
  const torch::Tensor information = slope_square * disparity_px * disparity_px;
  const torch::Tensor scale = 1.0 / (information + kRidge);
  return {(slope_change * disparity_px * scale).clamp(-kLargestCue, kLargestCue), information * scale};
}

torch::Tensor shrink(const torch::Tensor& x, int factor) {
  return factor == 1 ? x : torch::avg_pool2d(x, factor, factor, 0, /*ceil_mode=*/true);
}

torch::Tensor enlarge(const torch::Tensor& x, std::int64_t height, std::int64_t width) {
  if (x.size(2) == height && x.size(3) == width) return x;
  return F::interpolate(x, F::InterpolateFuncOptions()
                               .size(std::vector<std::int64_t>{height, width})
                               .mode(torch::kBilinear)
                               .align_corners(false));
}

}  // namespace

torch::Tensor stereo_cue(const torch::Tensor& left, const torch::Tensor& right, const torch::Tensor& prior_m,
                         const torch::Tensor& focal_baseline_px_m) {
  const bool shapes = left.dim() == 4 && left.sizes() == right.sizes() && prior_m.dim() == 4 &&
                      prior_m.size(1) == 1 && prior_m.sizes().slice(2) == left.sizes().slice(2) &&
                      focal_baseline_px_m.sizes().equals({left.size(0)});
  if (!shapes || left.size(2) < 8 || left.size(3) < 8) {
    throw std::invalid_argument(
        "stereo_cue: expected left and right [B,3,H,W] of 8 px and more, prior_m [B,1,H,W], focal_baseline "
        "[B]");
  }
  const torch::Tensor known = (prior_m > 0).to(prior_m.dtype());
  const torch::Tensor disparity_px = known * focal_baseline_px_m.view({-1, 1, 1, 1}) /
                                     torch::where(prior_m > 0, prior_m, torch::ones_like(prior_m));
  const torch::Tensor there = (right.amax({1, 2, 3}, /*keepdim=*/true) > 0).to(left.dtype());  // [B,1,1,1]
  const torch::Tensor left_grey = grey(left);
  const WarpedRight warped = warp(grey(right), disparity_px);
  const torch::Tensor valid = warped.valid * known * there;
  std::vector<torch::Tensor> channels;
  for (int scale = 0; scale < kScales; ++scale) {
    const int factor = 1 << scale;
    for (const torch::Tensor& channel :
         cue_at_scale(shrink(left_grey, factor), shrink(warped.image, factor), shrink(valid, factor),
                      shrink(disparity_px, factor) / factor)) {
      channels.push_back(enlarge(channel, left.size(2), left.size(3)));
    }
  }
  return torch::cat(channels, 1);
}

}  // namespace alight
