#pragma once

#include <cstdint>

#include <torch/torch.h>

namespace alight {

/// Channels that stereo_cue() returns: an estimate and its weight at every scale.
constexpr std::int64_t kStereoCueChannels = 6;

/// What the right camera says about depth, as one step of Lucas and Kanade (1981) around a prior: the right image is
/// warped by the prior's disparity, and the least-squares shift that is left over in a window around a pixel tells how
/// much nearer than the prior the surface is. Done on the image, its half and its quarter, because a step only reaches
/// as far as the image is smooth.
///
/// The shift is divided by the prior's disparity and shrunk towards 0 where texture and disparity are too weak to tell
/// (ridge term), so that a window without texture, and 40 m of height, say "no evidence" in place of noise. With a
/// baseline of 0.08 m and f = 440 px a metre is 0.09 px at 20 m.
/// @param left, right [B,3,H,W] in 0..1 @param prior_m [B,1,H,W] plane depth, 0 = unknown
/// @param focal_baseline_px_m [B], 0 = mono
/// @returns [B,kStereoCueChannels,H,W]: per scale, fine to coarse, -ln(depth / prior) as far as it is known, in
/// [-1.5, 1.5], and how far that is, 0..1; both 0 without right image or prior
torch::Tensor stereo_cue(const torch::Tensor& left, const torch::Tensor& right, const torch::Tensor& prior_m,
                         const torch::Tensor& focal_baseline_px_m);

}  // namespace alight
