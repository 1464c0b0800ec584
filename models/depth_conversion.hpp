#pragma once

#include <cstdint>

#include <torch/torch.h>

#include "geometry/depth_map.hpp"

namespace alight {

/// Length of each pixel's viewing ray at plane depth 1: perspective = plane * ray_lengths, as
/// geometry/depth_map.hpp.
/// @param intrinsics_px [B,4] fx fy cx cy, pixels of the height x width image @returns [B,1,height,width],
/// its dtype
torch::Tensor ray_lengths(const torch::Tensor& intrinsics_px, std::int64_t height_px, std::int64_t width_px);

/// METHOD, "Depth"; paper 3.3 step 1. depth [B,1,H,W] metres, 0 = missing stays 0; intrinsics as above.
torch::Tensor plane_to_perspective(const torch::Tensor& depth_m, const torch::Tensor& intrinsics_px);
torch::Tensor perspective_to_plane(const torch::Tensor& range_m, const torch::Tensor& intrinsics_px);

/// Plane depth <-> what a network of that `depth_kind` reads and predicts; the identity for `plane`.
torch::Tensor to_network_depth(const torch::Tensor& plane_m, const torch::Tensor& intrinsics_px,
                               DepthKind kind);
torch::Tensor from_network_depth(const torch::Tensor& depth_m, const torch::Tensor& intrinsics_px,
                                 DepthKind kind);

}  // namespace alight
