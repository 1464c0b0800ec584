#include "models/split_decoder.hpp"

#include <string>

#include "models/layers/convolution.hpp"
#include "models/layers/join_maps.hpp"

namespace alight {
namespace {

torch::nn::Sequential block_of(const DepthCompletionNet& net, const std::string& name) {
  return torch::nn::Sequential(
      std::dynamic_pointer_cast<torch::nn::SequentialImpl>(net->named_modules()[name]));
}

/// Takes the input channels of a convolution's weight one group after the other.
struct InputChannels {
  torch::Tensor weight;  // [out,in,3,3]
  std::int64_t at = 0;

  torch::Tensor next(std::int64_t count) {
    const torch::Tensor part = weight.narrow(1, at, count).clone();
    at += count;
    return part;
  }
  bool all_taken() const { return at == weight.size(1); }
};

/// [..,3] over an enlarged row -> [2,..,2] over the row itself: what the even and the odd pixel of a pair see. The even
/// one lies on values i-1, i, i; the odd one on i, i, i+1.
std::pair<torch::Tensor, torch::Tensor> pair_weights(const torch::Tensor& weight, std::int64_t axis) {
  const auto tap = [&](std::int64_t i) { return weight.narrow(axis, i, 1); };
  return {torch::cat({tap(0), tap(1) + tap(2)}, axis), torch::cat({tap(0) + tap(1), tap(2)}, axis)};
}

/// [out,in,3,3] over an enlarged map -> [4*out,in,2,2] over the map itself: blocks of even and odd rows, in them of even
/// and odd columns.
torch::Tensor block_weights(const torch::Tensor& weight) {
  const auto [even, odd] = pair_weights(weight, 2);
  const auto [even_even, even_odd] = pair_weights(even, 3);
  const auto [odd_even, odd_odd] = pair_weights(odd, 3);
  return torch::cat({even_even, even_odd, odd_even, odd_odd}, 0);
}

/// With the one pixel around it that kernels of 3 and of 2 want alike.
torch::Tensor convolve(const torch::Tensor& x, const torch::Tensor& weight, const torch::Tensor& bias = {}) {
  return alight::convolve(x, weight, bias, /*stride=*/1, /*padding=*/1);
}

/// Whether weights are those of block_weights().
bool makes_blocks(const torch::Tensor& weight) { return weight.size(2) == 2; }

/// What follows the convolution in its block.
torch::Tensor activate(torch::nn::Sequential block, torch::Tensor x) {
  for (auto layer = block->begin() + 1; layer != block->end(); ++layer) x = layer->forward(x);
  return x;
}

/// x [B,C,H,W] and the network's input [B,D,H,W] in one map of x's type, channels-last.
torch::Tensor with_input(const torch::Tensor& x, const torch::Tensor& input) {
  torch::Tensor both = torch::empty({x.size(0), x.size(1) + input.size(1), x.size(2), x.size(3)},
                                    x.options().memory_format(torch::MemoryFormat::ChannelsLast));
  both.narrow(1, 0, x.size(1)).copy_(x);
  both.narrow(1, x.size(1), input.size(1)).copy_(input);
  return both;
}

bool only_rectifies(const torch::nn::Sequential& block) {
  return block->size() == 2 && block->ptr(1)->as<torch::nn::ReLU>() != nullptr;
}

}  // namespace

SplitDecoder::SplitDecoder(const DepthCompletionNet& net) : net_(net) {
  const torch::NoGradGuard guard;
  for (std::size_t i = 0; i < net->config().decoder_widths.size(); ++i) levels_.push_back(split_level(i));
  if (net->config().detail_width > 0) detail_ = split_detail();
}

SplitDecoder::Level SplitDecoder::split_level(std::size_t index) const {
  const DepthCompletionConfig& config = net_->config();
  const bool sum = config.fusion == Fusion::kSum;
  Level level;
  level.block = block_of(net_, "decoder" + std::to_string(index + 1));
  const auto* conv = level.block->ptr(0)->as<torch::nn::Conv2d>();
  level.bias = conv->bias.defined() ? conv->bias.clone() : torch::Tensor();
  InputChannels channels{conv->weight};

  // The maps of the downsampling encoder halve at every level; the other's two finest are of one size.
  const bool enlarges = config.stem == Stem::kDownsample || index + 2 < config.decoder_widths.size();
  const auto below = [&](const torch::Tensor& weight) { return enlarges ? block_weights(weight) : weight; };
  if (index == 0) {
    level.image_below = below(channels.next(config.image_widths[3]));
    level.below = sum ? level.image_below : below(channels.next(config.depth_widths[3]));
  } else {
    level.below = below(channels.next(config.decoder_widths[index - 1]));
  }
  if (!channels.all_taken()) {
    const std::size_t stage = index < 3 ? 2 - index : 0;  // the stem is as wide as stage 1
    level.image_skip = channels.next(config.image_widths[stage]);
    level.depth_skip = sum ? level.image_skip : channels.next(config.depth_widths[stage]);
  } else if (level.bias.defined() && enlarges) {
    level.bias = level.bias.repeat(4);
  }
  return level;
}

SplitDecoder::Level SplitDecoder::split_detail() const {
  const DepthCompletionConfig& config = net_->config();
  Level level;
  level.block = block_of(net_, "detail");
  const auto* conv = level.block->ptr(0)->as<torch::nn::Conv2d>();
  level.bias = conv->bias.defined() ? conv->bias.clone() : torch::Tensor();
  InputChannels channels{conv->weight};
  const torch::Tensor below = channels.next(config.decoder_widths.back());
  level.image_skip = channels.next(image_channels(config));
  level.below = torch::cat({below, channels.next(depth_channels(config.depth_input))}, 1);
  return level;
}

void SplitDecoder::to(torch::Device device, torch::Dtype type) {
  const auto move = [&](Level& level) {
    for (torch::Tensor* x : {&level.image_below, &level.image_skip, &level.below, &level.depth_skip}) {
      if (x->defined()) *x = x->to(device, type).contiguous(torch::MemoryFormat::ChannelsLast);
    }
    if (level.bias.defined()) level.bias = level.bias.to(device, type);
  };
  for (Level& level : levels_) move(level);
  if (detail_) move(*detail_);
}

std::vector<torch::Tensor> SplitDecoder::image_part(const std::vector<torch::Tensor>& image_pyramid) const {
  std::vector<torch::Tensor> parts;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const Level& level = levels_[i];
    torch::Tensor part;
    if (level.sees_image())
      part = convolve(image_pyramid[levels_.size() - 1 - i], level.image_skip, level.bias);
    if (level.image_below.defined()) {
      part = join_maps(convolve(image_pyramid.back(), level.image_below), makes_blocks(level.image_below),
                       {part},
                       /*rectify=*/false);
    }
    parts.push_back(part);
  }
  if (detail_) {
    const torch::Tensor input =
        image_pyramid[0].to(detail_->image_skip.dtype()).contiguous(torch::MemoryFormat::ChannelsLast);
    parts.push_back(convolve(input, detail_->image_skip, detail_->bias));
  }
  return parts;
}

torch::Tensor SplitDecoder::decode(const std::vector<torch::Tensor>& image_part,
                                   const std::vector<torch::Tensor>& depth_pyramid) {
  const torch::Tensor& input = depth_pyramid[0];
  torch::Tensor x = depth_pyramid.back();  // [B,w3,H/32,W/32]
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const Level& level = levels_[i];
    const torch::Tensor y = convolve(x, level.below, level.sees_image() ? torch::Tensor() : level.bias);
    std::vector<torch::Tensor> addends;
    if (level.sees_image())
      addends = {convolve(depth_pyramid[levels_.size() - 1 - i], level.depth_skip), image_part[i]};
    const bool rectify = only_rectifies(level.block);
    torch::Tensor map = join_maps(y, makes_blocks(level.below), addends, rectify);
    x = rectify ? map : activate(level.block, map);
  }
  x = x.narrow(2, 0, input.size(2)).narrow(3, 0, input.size(3));
  if (detail_) {
    const torch::Tensor y = convolve(with_input(x, input), detail_->below);
    const bool rectify = only_rectifies(detail_->block);
    const torch::Tensor map = join_maps(y, false, {image_part.back()}, rectify);
    x = rectify ? map : activate(detail_->block, map);
  }
  return net_->depth_of(x, input);
}

}  // namespace alight
