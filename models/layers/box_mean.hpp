#pragma once

#include <cstdint>

#include <torch/torch.h>

namespace alight {

/// Mean over the square of odd side around every pixel, or over the part of it inside the map.
/// Sums of 1, 2, 4, ... neighbours are added up, in one direction after the other: some whole-map additions, which on a
/// processor take a tenth of the time of torch::avg_pool2d.
/// @param x [B,C,H,W] @returns the same shape
torch::Tensor box_mean(const torch::Tensor& x, std::int64_t side_px);

}  // namespace alight
