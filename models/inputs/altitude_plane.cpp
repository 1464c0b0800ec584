#include "models/inputs/altitude_plane.hpp"

#include <stdexcept>

namespace alight {
namespace {

constexpr double kNearest_m = 1e-3;

}  // namespace

torch::Tensor altitude_planes(const torch::Tensor& height_m, const torch::Tensor& down_camera,
                              const torch::Tensor& intrinsics_px, std::int64_t height_px,
                              std::int64_t width_px, double max_depth_m) {
  const std::int64_t batch = height_m.numel();
  if (!down_camera.sizes().equals({batch, 3}) || !intrinsics_px.sizes().equals({batch, 4})) {
    throw std::invalid_argument("altitude_planes: expected height [B], down_camera [B,3], intrinsics [B,4]");
  }
  const torch::Tensor down = down_camera.to(torch::kFloat64);
  const torch::Tensor k = intrinsics_px.to(torch::kFloat64);
  const torch::Tensor height = height_m.to(torch::kFloat64).view({-1, 1, 1, 1});
  const auto column = [](const torch::Tensor& x, std::int64_t i) {
    return x.select(1, i).view({-1, 1, 1, 1});
  };
  const torch::Tensor u = torch::arange(width_px, k.options()).view({1, 1, 1, -1});
  const torch::Tensor v = torch::arange(height_px, k.options()).view({1, 1, -1, 1});
  // How far a ray of plane depth 1 goes down.
  const torch::Tensor fall = column(down, 0) * (u - column(k, 2)) / column(k, 0) +
                             column(down, 1) * (v - column(k, 3)) / column(k, 1) + column(down, 2);
  const torch::Tensor depth_m = (height / fall.clamp_min(1e-9)).clamp(kNearest_m, max_depth_m);
  const torch::Tensor known = (height > 0) & height.isfinite() & down.isfinite().all(1).view({-1, 1, 1, 1});
  return torch::where(known, depth_m, torch::zeros_like(depth_m)).to(torch::kFloat32);
}

torch::Tensor altitude_plane(double height_m, const Eigen::Vector3d& down_camera,
                             const torch::Tensor& intrinsics_px, std::int64_t height_px,
                             std::int64_t width_px, double max_depth_m) {
  const torch::Tensor down =
      torch::tensor({down_camera.x(), down_camera.y(), down_camera.z()}, torch::kFloat64);
  return altitude_planes(torch::tensor({height_m}, torch::kFloat64), down.unsqueeze(0),
                         intrinsics_px.unsqueeze(0), height_px, width_px, max_depth_m);
}

}  // namespace alight
