#include "models/sparse_fill.hpp"

#include <stdexcept>
#include <vector>

#include "models/box_mean.hpp"

namespace alight {
namespace {

/// Mean of the valid values under a pixel of some level.
struct Level {
  torch::Tensor weighted_value;  // [B,1,h,w] share of valid pixels times their mean
  torch::Tensor weight;          // [B,1,h,w] share of valid pixels
};

/// Half the size. Windows over the edge divide both by the same count, so that their ratio stays a mean.
Level pull(const Level& fine) {
  const auto half = [](const torch::Tensor& x) { return torch::avg_pool2d(x, 2, 2, 0, /*ceil_mode=*/true); };
  return {half(fine.weighted_value), half(fine.weight)};
}

/// Twice the size, cut to that of `like` (whose pyramid was rounded up). Pixel centres stay where they are.
torch::Tensor enlarge(const torch::Tensor& coarse, const torch::Tensor& like) {
  using torch::indexing::None;
  using torch::indexing::Slice;
  const auto options = torch::nn::functional::InterpolateFuncOptions()
                           .scale_factor(std::vector<double>{2.0, 2.0})
                           .mode(torch::kBilinear)
                           .align_corners(false);
  return torch::nn::functional::interpolate(coarse, options)
      .index({Slice(), Slice(), Slice(None, like.size(2)), Slice(None, like.size(3))});
}

}  // namespace

SparseFill fill_pyramid(const torch::Tensor& value, const torch::Tensor& valid, int smoothing) {
  if (value.dim() != 4 || value.size(1) != 1 || value.sizes() != valid.sizes()) {
    throw std::invalid_argument("fill_pyramid: expected value and valid [B,1,H,W]");
  }
  std::vector<Level> levels{{torch::where(valid > 0, value, torch::zeros_like(value)), valid}};
  while (levels.back().weight.size(2) > 1 || levels.back().weight.size(3) > 1)
    levels.push_back(pull(levels.back()));

  const double coarsest = static_cast<double>(std::max<std::size_t>(levels.size() - 1, 1));
  SparseFill fill{torch::zeros_like(levels.back().weight), torch::ones_like(levels.back().weight)};
  for (std::size_t i = levels.size(); i-- > 0;) {
    const Level& level = levels[i];
    if (i + 1 < levels.size())
      fill = {enlarge(fill.value, level.weight), enlarge(fill.coarseness, level.weight)};
    const torch::Tensor known = level.weight > 0;
    const torch::Tensor mean = level.weighted_value / level.weight.clamp_min(1e-12);
    fill.value = torch::where(known, mean, fill.value);
    for (int pass = 0; pass < smoothing; ++pass) {
      fill.value = torch::where(known, mean, box_mean(fill.value, 3));
    }
    const double coarseness = static_cast<double>(i) / coarsest;
    fill.coarseness = torch::where(known, torch::full_like(fill.coarseness, coarseness), fill.coarseness);
  }
  return fill;
}

}  // namespace alight
