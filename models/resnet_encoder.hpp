#pragma once

#include <cstdint>
#include <vector>

#include <torch/torch.h>

namespace alight {

/// `downsample`: ResNet's stride-2 7x7 convolution and max-pooling. `full`: Ma et al.'s 3x3 convolution at
/// full resolution, about eight times the work.
enum class Stem { kDownsample, kFull };

/// `batch`: batch normalisation, folds into the convolutions for inference. `group`: group normalisation,
/// computes the same in training and inference whatever the batch holds. `none`: a bias in its place; what folding
/// leaves behind (models/fold_batch_norm.hpp).
enum class Normalization { kBatch, kGroup, kNone };

/// Groups of a `group` normalisation over so many channels.
std::int64_t group_count(std::int64_t channels);

/// A convolution ("conv") followed by normalisation ("norm") and, if `relu`, a rectifier ("relu").
torch::nn::Sequential conv_block(int in_channels, int out_channels, int kernel, int stride,
                                 Normalization normalization, bool relu = true);

/// Two 3x3 convolutions around a shortcut (He et al. 2016).
class BasicBlockImpl : public torch::nn::Module {
 public:
  BasicBlockImpl(int in_channels, int out_channels, int stride, Normalization normalization);
  /// [B,in,H,W] -> [B,out,ceil(H/stride),ceil(W/stride)]
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::nn::Sequential first_{nullptr};
  torch::nn::Sequential second_{nullptr};
  torch::nn::Sequential shortcut_{nullptr};  // null where shapes agree
};
TORCH_MODULE(BasicBlock);

/// Stem and four stages of two basic blocks: ResNet-18 without its classifier.
class ResnetEncoderImpl : public torch::nn::Module {
 public:
  /// @param widths channels of the four stages; the stem has the first's
  ResnetEncoderImpl(int in_channels, const std::vector<int>& widths, Stem stem, Normalization normalization);

  /// @param x [B,in,H,W], H and W multiples of stride()
  /// @returns five maps: the stem's (stride 2, or 1 for `full`), then the stages' (4, 8, 16, 32, or 1, 2, 4,
  /// 8)
  std::vector<torch::Tensor> forward(const torch::Tensor& x);

 private:
  Stem stem_kind_;
  torch::nn::Sequential stem_{nullptr};
  std::vector<torch::nn::Sequential> stages_;
};
TORCH_MODULE(ResnetEncoder);

/// Total stride of the coarsest map.
int encoder_stride(Stem stem);

}  // namespace alight
