#pragma once

#include <vector>

#include <torch/torch.h>

namespace alight {

/// What follows the convolutions of a level that was split by its inputs: their sum and the rectifier, in one sweep over
/// memory on a processor (float32 and bfloat16, channels-last), else by tensor operations.
/// @param y [B,C,H,W], or [B,4*C,h+1,w+1] with blocks: channel group 2*row+column holds the pixels (row, column) of every
/// 2x2 block of a map [B,C,2h,2w], which saw values i-1 and i along each axis
/// @param blocks whether `y` is so @param addends each [B,C,H,W] of the map's size and y's type
/// @param rectify negative values become 0
/// @param target [B,C,H,W] or a part of the channels of a larger channels-last tensor; may be smaller than the map, which
/// is then cut right and below; undefined: made, of the map's size
/// @returns target
torch::Tensor join_maps(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends,
                        bool rectify, torch::Tensor target = {});

}  // namespace alight
