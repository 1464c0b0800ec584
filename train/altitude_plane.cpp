#include "train/altitude_plane.hpp"

namespace alight {

torch::Tensor altitude_plane(double height_m, const Eigen::Vector3d& down_camera,
                             const torch::Tensor& intrinsics_px, std::int64_t height_px,
                             std::int64_t width_px, double max_depth_m) {
  const torch::Tensor k = intrinsics_px.to(torch::kFloat64);
  const torch::Tensor u = torch::arange(width_px, torch::kFloat64).view({1, 1, 1, -1});
  const torch::Tensor v = torch::arange(height_px, torch::kFloat64).view({1, 1, -1, 1});
  // How far a ray of plane depth 1 goes down.
  const torch::Tensor fall =
      down_camera.x() * (u - k[2]) / k[0] + down_camera.y() * (v - k[3]) / k[1] + down_camera.z();
  const double nearest_m = 1e-3;
  const torch::Tensor depth_m = (height_m / fall.clamp_min(1e-9)).clamp(nearest_m, max_depth_m);
  return depth_m.to(torch::kFloat32);
}

}  // namespace alight
