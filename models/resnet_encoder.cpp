#include "models/resnet_encoder.hpp"

#include <numeric>
#include <stdexcept>
#include <string>

#include "models/layers/convolution.hpp"

namespace alight {
namespace {

constexpr std::size_t kEncoderStages = 4;
constexpr std::int64_t kLargestGroupCount = 8;

/// torch::nn::GroupNorm on contiguous memory: the channels-last kernel of LibTorch 1.13 writes out of bounds.
class ContiguousGroupNormImpl : public torch::nn::Module {
 public:
  explicit ContiguousGroupNormImpl(int channels)
      : groups_(group_count(channels)),
        weight_(register_parameter("weight", torch::ones({channels}))),
        bias_(register_parameter("bias", torch::zeros({channels}))) {}
  torch::Tensor forward(const torch::Tensor& x) {
    return torch::group_norm(x.contiguous(), groups_, weight_, bias_);
  }

 private:
  std::int64_t groups_;
  torch::Tensor weight_;
  torch::Tensor bias_;
};
TORCH_MODULE(ContiguousGroupNorm);

torch::nn::Sequential stage(int in_channels, int out_channels, int stride, Normalization normalization) {
  return torch::nn::Sequential(BasicBlock(in_channels, out_channels, stride, normalization),
                               BasicBlock(out_channels, out_channels, 1, normalization));
}

torch::nn::Sequential make_stem(int in_channels, int width, Stem stem, Normalization normalization) {
  return stem == Stem::kDownsample ? conv_block(in_channels, width, 7, 2, normalization)
                                   : conv_block(in_channels, width, 3, 1, normalization);
}

}  // namespace

std::int64_t group_count(std::int64_t channels) { return std::gcd(channels, kLargestGroupCount); }

int encoder_stride(Stem stem) { return stem == Stem::kDownsample ? 32 : 8; }

torch::nn::Sequential conv_block(int in_channels, int out_channels, int kernel, int stride,
                                 Normalization normalization, bool relu) {
  torch::nn::Sequential block;
  // Normalisation subtracts the mean, so a bias would have no effect.
  const auto options = torch::nn::Conv2dOptions(in_channels, out_channels, kernel)
                           .stride(stride)
                           .padding(kernel / 2)
                           .bias(normalization == Normalization::kNone);
  Convolution conv(options);
  torch::nn::init::kaiming_normal_(conv->weight, 0.0, torch::kFanOut, torch::kReLU);
  block->push_back("conv", conv);
  if (normalization == Normalization::kBatch) {
    block->push_back("norm", torch::nn::BatchNorm2d(out_channels));
  } else if (normalization == Normalization::kGroup) {
    block->push_back("norm", ContiguousGroupNorm(out_channels));
  }
  if (relu) block->push_back("relu", torch::nn::ReLU(torch::nn::ReLUOptions(true)));
  return block;
}

BasicBlockImpl::BasicBlockImpl(int in_channels, int out_channels, int stride, Normalization normalization) {
  first_ = register_module("first", conv_block(in_channels, out_channels, 3, stride, normalization));
  second_ = register_module("second", conv_block(out_channels, out_channels, 3, 1, normalization, false));
  if (stride != 1 || in_channels != out_channels) {
    shortcut_ =
        register_module("shortcut", conv_block(in_channels, out_channels, 1, stride, normalization, false));
  }
}

torch::Tensor BasicBlockImpl::forward(const torch::Tensor& x) {
  torch::Tensor residual = second_->forward(first_->forward(x));
  return residual.add_(shortcut_ ? shortcut_->forward(x) : x).relu_();
}

ResnetEncoderImpl::ResnetEncoderImpl(int in_channels, const std::vector<int>& widths, Stem stem,
                                     Normalization normalization)
    : stem_kind_(stem) {
  if (widths.size() != kEncoderStages)
    throw std::invalid_argument("ResnetEncoder: expected the widths of four stages");
  stem_ = register_module("stem", make_stem(in_channels, widths[0], stem, normalization));
  for (std::size_t i = 0; i < kEncoderStages; ++i) {
    const int before = i == 0 ? widths[0] : widths[i - 1];
    const std::string name = "stage" + std::to_string(i + 1);
    stages_.push_back(register_module(name, stage(before, widths[i], i == 0 ? 1 : 2, normalization)));
  }
}

std::vector<torch::Tensor> ResnetEncoderImpl::forward(const torch::Tensor& x) {
  std::vector<torch::Tensor> maps{stem_->forward(x)};  // [B,w0,H/2,W/2], full stem: [B,w0,H,W]
  torch::Tensor map = maps.front();
  if (stem_kind_ == Stem::kDownsample) map = torch::max_pool2d(map, 3, 2, 1);  // [B,w0,H/4,W/4]
  for (auto& next : stages_) {
    map = next->forward(map);
    maps.push_back(map);
  }
  return maps;
}

}  // namespace alight
