#pragma once

#include <torch/torch.h>

namespace alight {

/// torch::conv2d, by oneDNN also where LibTorch 1.13 would take its own kernel, which is several times slower: for small
/// maps in float32 on a processor. @param x [B,in,H,W] @param weight [out,in,k,k] @param bias [out] or undefined
torch::Tensor convolve(const torch::Tensor& x, const torch::Tensor& weight, const torch::Tensor& bias,
                       std::int64_t stride, std::int64_t padding);

/// torch::nn::Conv2d with a square kernel, through convolve() where no gradient is wanted.
class ConvolutionImpl : public torch::nn::Conv2dImpl {
 public:
  using torch::nn::Conv2dImpl::Conv2dImpl;
  torch::Tensor forward(const torch::Tensor& x);
};
TORCH_MODULE(Convolution);

}  // namespace alight
