#pragma once

#include <torch/torch.h>

namespace alight {

/// Mean of `value` over the pixels where `mask` is true, so that a loss changes neither with image size nor
/// with density. No such pixel: 0, with a gradient of 0. Values outside the mask may be anything, even NaN.
/// @param value any shape @param mask bool, value's shape @returns scalar of value's type
torch::Tensor masked_mean(const torch::Tensor& value, const torch::Tensor& mask);

/// Mean of all elements; 0 with a gradient of 0 where there are none.
torch::Tensor mean_or_zero(const torch::Tensor& value);

}  // namespace alight
