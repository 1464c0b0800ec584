#pragma once

#include <torch/torch.h>

namespace alight {

/// A sparse map without its holes.
struct SparseFill {
  torch::Tensor value;  ///< [B,1,H,W]; 0 in samples that have no value at all
  torch::Tensor
      coarseness;  ///< [B,1,H,W], 0 at a given pixel .. 1 for the mean of the whole map (or none at all)
};

/// Fills holes from a pyramid of local means (pull-push): every pixel takes the finest level that has a value
/// around it, smoothly enlarged. Costs a few pooling passes, unlike a nearest-neighbour search, and stays on
/// the device.
/// @param value [B,1,H,W], any number where not valid @param valid [B,1,H,W], 1 or 0, same dtype
SparseFill fill_pyramid(const torch::Tensor& value, const torch::Tensor& valid);

}  // namespace alight
