#include "losses/smoothness_loss.hpp"

#include <stdexcept>

#include "foundation/config_reader.hpp"
#include "losses/masked_mean.hpp"

namespace alight {
namespace {

constexpr std::int64_t kRows = 2;
constexpr std::int64_t kColumns = 3;

torch::Tensor difference(const torch::Tensor& x, std::int64_t dim) {
  if (x.size(dim) < 2) return x.narrow(dim, 0, 0);
  return x.narrow(dim, 1, x.size(dim) - 1) - x.narrow(dim, 0, x.size(dim) - 1);
}

/// Small where the image has an edge. @returns [B,1,H-1,W] or [B,1,H,W-1]
torch::Tensor edge_weight(const torch::Tensor& image, std::int64_t dim, double sharpness) {
  return torch::exp(-sharpness * difference(image, dim).abs().mean(1, true));
}

/// Mean of |value| weighed by the part of `weight` that has value's size.
torch::Tensor weighed(const torch::Tensor& value, const torch::Tensor& weight) {
  if (!weight.defined()) return mean_or_zero(value.abs());
  return mean_or_zero(value.abs() * weight.narrow(2, 0, value.size(2)).narrow(3, 0, value.size(3)));
}

}  // namespace

void bind(Binder& b, SmoothnessLossConfig& c) {
  b.field("edge_aware", c.edge_aware, "spare depth edges where the image has edges");
  b.field("edge_sharpness", c.edge_sharpness, "how fast the weight falls with the image gradient",
          at_least(0));
  b.field("relative", c.relative, "smooth the logarithm of depth in place of depth");
}

torch::Tensor smoothness_loss(const torch::Tensor& depth_m, const torch::Tensor& image,
                              const SmoothnessLossConfig& config) {
  if (depth_m.dim() != 4 || depth_m.size(1) != 1) {
    throw std::invalid_argument("smoothness_loss: expected depth [B,1,H,W]");
  }
  torch::Tensor weight_x;
  torch::Tensor weight_y;
  if (config.edge_aware) {
    if (image.dim() != 4 || image.sizes().slice(2) != depth_m.sizes().slice(2)) {
      throw std::invalid_argument("smoothness_loss: expected an image [B,C,H,W] of the depth's size");
    }
    weight_x = edge_weight(image, kColumns, config.edge_sharpness);
    weight_y = edge_weight(image, kRows, config.edge_sharpness);
  }
  const torch::Tensor surface = config.relative ? depth_m.log() : depth_m;
  const torch::Tensor dx = difference(surface, kColumns);
  const torch::Tensor dy = difference(surface, kRows);
  return weighed(dx, weight_x) + weighed(dy, weight_y) + weighed(difference(dx, kColumns), weight_x) +
         2 * weighed(difference(dx, kRows), weight_x) + weighed(difference(dy, kRows), weight_y);
}

}  // namespace alight
