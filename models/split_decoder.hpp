#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <torch/torch.h>

#include "models/depth_completion_net.hpp"

namespace alight {

/// The network's decoder for inference, with the same result up to rounding and half the work a refinement:
/// - A convolution over concatenated maps is the sum of convolutions over each. What the image brings to every level does
///   not change as LiDAR points arrive, so it is computed once an image.
/// - A 3x3 convolution over a map enlarged to twice its size sees every value two or three times. On the small map it is
///   four 2x2 convolutions, one for each position of a pixel in its block, with sums of the same weights (Shi et al. 2016
///   call it sub-pixel convolution).
class SplitDecoder {
 public:
  /// @param net in evaluation mode and float32; its normalisations are kept by reference
  explicit SplitDecoder(const DepthCompletionNet& net);
  /// The weights' device and type, channels-last; the network has to be taken there, too.
  void to(torch::Device device, torch::Dtype type);

  /// What the image brings to every level. @param image_pyramid as DepthCompletionNet::decode takes it
  std::vector<torch::Tensor> image_part(const std::vector<torch::Tensor>& image_pyramid) const;
  /// @param image_part of image_part() @param depth_pyramid as DepthCompletionNet::decode takes it
  /// @returns depth [B,1,H,W], as DepthCompletionNet::decode
  torch::Tensor decode(const std::vector<torch::Tensor>& image_part,
                       const std::vector<torch::Tensor>& depth_pyramid);

 private:
  /// The convolution of a level, split by what it sees; undefined where it does not see it.
  struct Level {
    torch::nn::Sequential block{nullptr};  // its normalisation and rectifier follow
    torch::Tensor image_below;             // [4*out,image,2,2]; the coarsest level only
    torch::Tensor image_skip;              // [out,image,3,3]
    torch::Tensor below;                   // [4*out,below,2,2], or [out,below,3,3] where nothing is enlarged
    torch::Tensor depth_skip;              // [out,depth,3,3]
    torch::Tensor bias;  // [out]; of the image's part where there is one, else [4*out] of `below`

    bool sees_image() const { return image_skip.defined(); }
  };
  Level split_level(std::size_t index) const;
  Level split_detail() const;

  DepthCompletionNet net_;
  std::vector<Level> levels_;    // coarse to fine
  std::optional<Level> detail_;  // `below` is of the level below and the depth input together
};

}  // namespace alight
