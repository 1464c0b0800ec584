#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <torch/torch.h>

namespace alight {

/// The opponent that needs neither network nor LiDAR (METHOD, "The opponent"): level ground at the height
/// that the vehicle reports, seen with the camera's attitude. Rays at or above the horizon get `max_depth_m`.
/// @param intrinsics_px [4] fx fy cx cy @param down_camera the world's down in camera coordinates, unit
/// length
/// @returns [1,1,height,width] float32, plane depth in metres
torch::Tensor altitude_plane(double height_m, const Eigen::Vector3d& down_camera,
                             const torch::Tensor& intrinsics_px, std::int64_t height_px,
                             std::int64_t width_px, double max_depth_m);

}  // namespace alight
