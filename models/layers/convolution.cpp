#include "models/layers/convolution.hpp"

#include <variant>

namespace alight {
namespace {

bool by_onednn(const torch::Tensor& x) {
  return x.device().is_cpu() && x.scalar_type() == torch::kFloat32 && !torch::GradMode::is_enabled() &&
         at::globalContext().hasMKLDNN() && at::globalContext().userEnabledMkldnn();
}

}  // namespace

torch::Tensor convolve(const torch::Tensor& x, const torch::Tensor& weight, const torch::Tensor& bias,
                       std::int64_t stride, std::int64_t padding) {
  if (!by_onednn(x)) return torch::conv2d(x, weight, bias, stride, padding);
  return at::mkldnn_convolution(x, weight, bias, {padding, padding}, {stride, stride}, {1, 1}, 1);
}

torch::Tensor ConvolutionImpl::forward(const torch::Tensor& x) {
  if (!by_onednn(x)) return torch::nn::Conv2dImpl::forward(x);
  using std::
      get;  // a std::variant since LibTorch 2.1, before that c10's own, whose get() is found by its argument
  return convolve(x, weight, bias, options.stride()->front(),
                  get<torch::ExpandingArray<2>>(options.padding())->front());
}

}  // namespace alight
