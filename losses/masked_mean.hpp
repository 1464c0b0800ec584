#pragma once

#include <torch/torch.h>

namespace alight {

/// Mean over each sample's pixels that count.
struct SampleMeans {
  torch::Tensor mean;  ///< [B]; 0 with a gradient of 0 where no pixel counts
  torch::Tensor any;   ///< [B] bool: a pixel counts
};

/// @param value [B,...] of any type of float; outside the mask it may be anything, even NaN @param mask bool, its shape
SampleMeans sample_means(const torch::Tensor& value, const torch::Tensor& mask);

/// Mean over the samples that have a pixel that counts; 0 with a gradient of 0 where none has. @returns scalar
torch::Tensor mean_over_samples(const SampleMeans& means);

/// Both: the mean over the pixels that count of each sample, then over the samples, so that a loss changes neither with
/// image size nor with density, a sample with few points weighs as much as one with many, and the gradients of two
/// halves of a batch average to that of the whole.
torch::Tensor masked_mean(const torch::Tensor& value, const torch::Tensor& mask);

/// Mean of all elements; 0 with a gradient of 0 where there are none.
torch::Tensor mean_or_zero(const torch::Tensor& value);

}  // namespace alight
