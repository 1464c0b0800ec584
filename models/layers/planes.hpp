#pragma once

#include <opencv2/core.hpp>
#include <torch/torch.h>

namespace alight {

/// Maps of one channel as OpenCV's matrices (CV_32FC1). What a network is fed with takes hundreds of small tensor
/// operations a frame; on a processor a few sweeps over planes are several times faster.

/// Whether the planes of `x` [B,C,H,W] can be worked on in place of the tensor: float32, on the processor, no gradient.
bool has_planes(const torch::Tensor& x);

/// One plane of a contiguous tensor [B,C,H,W] with has_planes(). Shares its memory; the tensor has to outlive it.
cv::Mat plane_of(const torch::Tensor& x, std::int64_t sample, std::int64_t channel);

/// As box_mean() of tensors: mean over the part of a square window that lies inside. @param side_px odd
cv::Mat box_mean(const cv::Mat& plane, int side_px);

/// Means of squares of `factor` pixels; those over the right and lower edge are of what lies inside.
cv::Mat shrink(const cv::Mat& plane, int factor);

}  // namespace alight
