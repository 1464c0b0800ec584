#pragma once

#include <torch/torch.h>

namespace alight {

/// The target view rebuilt from a source image.
struct SynthesisedView {
  torch::Tensor image;  ///< [B,C,H,W]
  torch::Tensor valid;  ///< [B,1,H,W] bool: the pixel lands inside the source, in front of it
};

/// Inverse warp (paper 3.2, photometric loss; Godard et al. 2017): every target pixel becomes a point at its
/// depth, moves to the source camera and takes the source's colour there, bilinearly. Differentiable in depth
/// and image. Pixel (0, 0) is the centre of the top left pixel, as in geometry/camera.hpp.
/// @param source [B,C,H,W] @param depth_target_m [B,1,H,W] plane depth, positive
/// @param intrinsics_px [B,4] fx fy cx cy of both views @param T_source_target [B,4,4]
SynthesisedView synthesise_view(const torch::Tensor& source, const torch::Tensor& depth_target_m,
                                const torch::Tensor& intrinsics_px, const torch::Tensor& T_source_target);

}  // namespace alight
