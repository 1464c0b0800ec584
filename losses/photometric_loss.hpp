#pragma once

#include <vector>

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// How the errors against several sources become one: `mean` over the sources (the paper), or at every pixel
/// the smallest (monodepth2), which forgives what one source does not see.
enum class PhotometricReduction { kMean, kMin };

/// Weight and sources of the photometric loss (paper 3.2).
struct PhotometricLossConfig {
  double ssim_weight = 0.85;  ///< alpha; the rest weighs the absolute difference
  PhotometricReduction reduction = PhotometricReduction::kMean;
  bool use_previous = true;
  bool use_next = true;
  bool use_right = true;
};
void bind(Binder& b, PhotometricLossConfig& c);

/// Another view of the scene.
struct PhotometricSource {
  torch::Tensor image;            ///< [B,3,H,W] in 0..1
  torch::Tensor T_source_target;  ///< [B,4,4]
  torch::Tensor present;  ///< [B] bool: false leaves the source out for that sample (first frame, mono)
};

/// alpha (1 - SSIM) / 2 + (1 - alpha) |a - b|, mean over the channels. @param a, b [B,C,H,W] @returns
/// [B,1,H,W]
torch::Tensor photometric_error(const torch::Tensor& a, const torch::Tensor& b, double ssim_weight);

/// Photometric loss (paper 3.2, C_p; METHOD, "Losses"): the target image against its reconstructions from the
/// sources, only where the warped pixel lands inside the source. `mean`: mean over a source's pixels, then
/// over the sources that have any, then over the samples. No pixel at all: 0.
/// @param target [B,3,H,W] in 0..1 @param depth_m [B,1,H,W] plane depth of the target, positive
/// @param intrinsics_px [B,4] fx fy cx cy, of all views @returns scalar
torch::Tensor photometric_loss(const torch::Tensor& target, const torch::Tensor& depth_m,
                               const torch::Tensor& intrinsics_px,
                               const std::vector<PhotometricSource>& sources,
                               const PhotometricLossConfig& config);

}  // namespace alight
