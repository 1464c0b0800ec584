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
/// @param smoothing passes at every level in which a hole becomes the mean of its 3x3 neighbourhood while what is
/// known stays: a multigrid step towards the membrane that is stretched over the points, which is about as near to the
/// surface as linear interpolation. 0: none, steps of the coarser level's pixels stay visible.
SparseFill fill_pyramid(const torch::Tensor& value, const torch::Tensor& valid, int smoothing = 0);

}  // namespace alight
