#include "models/depth_conversion.hpp"

#include <stdexcept>

namespace alight {
namespace {

void check_depth(const torch::Tensor& depth) {
  if (depth.dim() != 4 || depth.size(1) != 1)
    throw std::invalid_argument("depth conversion: expected depth [B,1,H,W]");
}

}  // namespace

torch::Tensor ray_lengths(const torch::Tensor& intrinsics_px, std::int64_t height_px, std::int64_t width_px) {
  if (intrinsics_px.dim() != 2 || intrinsics_px.size(1) != 4) {
    throw std::invalid_argument("ray_lengths: expected intrinsics [B,4]");
  }
  const auto column = [&](std::int64_t i) { return intrinsics_px.select(1, i).view({-1, 1, 1, 1}); };
  const torch::Tensor u = torch::arange(width_px, intrinsics_px.options()).view({1, 1, 1, -1});
  const torch::Tensor v = torch::arange(height_px, intrinsics_px.options()).view({1, 1, -1, 1});
  const torch::Tensor x = (u - column(2)) / column(0);  // [B,1,1,W]
  const torch::Tensor y = (v - column(3)) / column(1);  // [B,1,H,1]
  return (x * x + y * y + 1).sqrt();
}

torch::Tensor plane_to_perspective(const torch::Tensor& depth_m, const torch::Tensor& intrinsics_px) {
  check_depth(depth_m);
  return depth_m * ray_lengths(intrinsics_px, depth_m.size(2), depth_m.size(3));
}

torch::Tensor perspective_to_plane(const torch::Tensor& range_m, const torch::Tensor& intrinsics_px) {
  check_depth(range_m);
  return range_m / ray_lengths(intrinsics_px, range_m.size(2), range_m.size(3));
}

torch::Tensor to_network_depth(const torch::Tensor& plane_m, const torch::Tensor& intrinsics_px,
                               DepthKind kind) {
  return kind == DepthKind::kPlane ? plane_m : plane_to_perspective(plane_m, intrinsics_px);
}

torch::Tensor from_network_depth(const torch::Tensor& depth_m, const torch::Tensor& intrinsics_px,
                                 DepthKind kind) {
  return kind == DepthKind::kPlane ? depth_m : perspective_to_plane(depth_m, intrinsics_px);
}

}  // namespace alight
