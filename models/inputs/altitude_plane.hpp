#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <torch/torch.h>

namespace alight {

/// The opponent that needs neither network nor LiDAR (METHOD, "The opponent"), and the prior of a network that is told
/// the flight's height: level ground at the height that the vehicle reports, seen with the camera's attitude. Rays at or
/// above the horizon get `max_depth_m`.
/// @param intrinsics_px [4] fx fy cx cy @param down_camera the world's down in camera coordinates, unit length
/// @returns [1,1,height,width] float32, plane depth in metres
torch::Tensor altitude_plane(double height_m, const Eigen::Vector3d& down_camera,
                             const torch::Tensor& intrinsics_px, std::int64_t height_px,
                             std::int64_t width_px, double max_depth_m);

/// The same for a batch. A sample whose height is not a positive number, or whose attitude is not finite, is 0: unknown.
/// @param height_m [B] @param down_camera [B,3] @param intrinsics_px [B,4] @returns [B,1,height,width] float32
torch::Tensor altitude_planes(const torch::Tensor& height_m, const torch::Tensor& down_camera,
                              const torch::Tensor& intrinsics_px, std::int64_t height_px,
                              std::int64_t width_px, double max_depth_m);

}  // namespace alight
