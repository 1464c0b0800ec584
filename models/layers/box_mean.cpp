#include "models/layers/box_mean.hpp"

#include <stdexcept>

namespace alight {
namespace {

/// Sums of `count` neighbours along `dim`, which becomes shorter by count - 1.
torch::Tensor running_sum(const torch::Tensor& x, std::int64_t dim, std::int64_t count) {
  const std::int64_t length = x.size(dim) - count + 1;
  torch::Tensor power = x;  // sums of `size` neighbours
  torch::Tensor sum;
  std::int64_t offset = 0;
  for (std::int64_t size = 1; size <= count; size *= 2) {
    if (size > 1) {
      const std::int64_t left = power.size(dim) - size / 2;
      power = power.narrow(dim, 0, left) + power.narrow(dim, size / 2, left);
    }
    if ((count & size) == 0) continue;
    const torch::Tensor part = power.narrow(dim, offset, length);
    sum = sum.defined() ? sum + part : part;
    offset += size;
  }
  return sum;
}

/// How many of the `side` neighbours around each of `length` places lie inside. @returns [length]
torch::Tensor inside(std::int64_t length, std::int64_t side, const torch::TensorOptions& options) {
  const torch::Tensor place = torch::arange(length, options);
  const double half = static_cast<double>(side / 2);
  return place.clamp_max(half) + (static_cast<double>(length - 1) - place).clamp_max(half) + 1;
}

}  // namespace

torch::Tensor box_mean(const torch::Tensor& x, std::int64_t side_px) {
  if (x.dim() != 4 || side_px < 1 || side_px % 2 == 0) {
    throw std::invalid_argument("box_mean: expected a map [B,C,H,W] and an odd side");
  }
  const std::int64_t half = side_px / 2;
  const torch::Tensor along_rows =
      running_sum(torch::constant_pad_nd(x, {half, half, half, half}), 3, side_px);
  const torch::Tensor columns = inside(x.size(3), side_px, x.options());
  const torch::Tensor rows = inside(x.size(2), side_px, x.options());
  return running_sum(along_rows, 2, side_px) * (1.0 / columns) * (1.0 / rows).unsqueeze(1);
}

}  // namespace alight
