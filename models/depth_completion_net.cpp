#include "models/depth_completion_net.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/sparse_fill.hpp"

namespace alight {
namespace {

namespace F = torch::nn::functional;
constexpr std::size_t kStages = 4;
constexpr std::size_t kDecoderLevels = 5;
// Of the logarithmic range: with 0.5..150 m the fill is corrected by up to a third.
constexpr double kLargestResidual = 0.05;

int depth_channels(DepthInput input) {
  return input == DepthInput::kRaw ? 1 : input == DepthInput::kMasked ? 2 : 4;
}

bool all_positive(const std::vector<int>& widths) {
  return std::all_of(widths.begin(), widths.end(), [](int width) { return width > 0; });
}

/// Empty if the parts fit together, else what does not.
std::string mistake(const DepthCompletionConfig& c) {
  if (c.image_widths.size() != kStages || !all_positive(c.image_widths))
    return "image_widths: four positive numbers";
  if (c.depth_widths.size() != kStages || !all_positive(c.depth_widths))
    return "depth_widths: four positive numbers";
  if (c.decoder_widths.size() != kDecoderLevels || !all_positive(c.decoder_widths)) {
    return "decoder_widths: five positive numbers";
  }
  if (c.fusion == Fusion::kSum && c.depth_widths != c.image_widths) {
    return "depth_widths: equal to image_widths, because fusion: sum adds the maps";
  }
  if (!(c.min_depth_m > 0 && c.max_depth_m > c.min_depth_m)) return "max_depth_m: more than min_depth_m";
  if (c.head == Head::kGated && c.depth_input != DepthInput::kFilled) {
    return "head: direct, or depth_input: filled, because the gate mixes with the fill";
  }
  return {};
}

/// Pads to a multiple of the encoder's stride, right and below, where decode() cuts.
torch::Tensor pad(const torch::Tensor& x, int stride, bool replicate) {
  const std::int64_t right = (stride - x.size(3) % stride) % stride;
  const std::int64_t below = (stride - x.size(2) % stride) % stride;
  if (right == 0 && below == 0) return x;
  auto options = F::PadFuncOptions({0, right, 0, below});
  return replicate ? F::pad(x, options.mode(torch::kReplicate)) : F::pad(x, options);
}

torch::Tensor enlarge_to(const torch::Tensor& x, std::int64_t height, std::int64_t width) {
  if (x.size(2) == height && x.size(3) == width) return x;
  return F::interpolate(
      x, F::InterpolateFuncOptions().size(std::vector<std::int64_t>{height, width}).mode(torch::kNearest));
}

void check_shape(const torch::Tensor& x, std::int64_t channels, const char* what) {
  if (x.dim() == 4 && x.size(1) == channels && x.size(2) > 0 && x.size(3) > 0 && x.is_floating_point())
    return;
  throw std::invalid_argument(std::string("DepthCompletionNet: ") + what +
                              " must be a floating point tensor");
}

/// Where a depth lies between the limits, 0..1, in equal ratios.
torch::Tensor to_log_share(const torch::Tensor& depth_m, const DepthCompletionConfig& c) {
  return (depth_m.clamp(c.min_depth_m, c.max_depth_m) / c.min_depth_m).log() /
         std::log(c.max_depth_m / c.min_depth_m);
}

}  // namespace

void bind(Binder& b, DepthCompletionConfig& c) {
  b.choice("stem", c.stem, {{"downsample", Stem::kDownsample}, {"full", Stem::kFull}},
           "first layer: stride 2 and pooling, or full resolution");
  b.choice("normalization", c.normalization,
           {{"batch", Normalization::kBatch}, {"group", Normalization::kGroup}},
           "normalisation after every convolution");
  b.choice("fusion", c.fusion, {{"concatenate", Fusion::kConcatenate}, {"sum", Fusion::kSum}},
           "how image and depth features meet at every scale of the decoder");
  b.field("image_widths", c.image_widths, "channels of the image encoder's four stages");
  b.field("depth_widths", c.depth_widths, "channels of the depth encoder's four stages");
  b.field("decoder_widths", c.decoder_widths, "channels of the decoder's five levels, coarse to fine");
  b.choice("depth_input", c.depth_input,
           {{"raw", DepthInput::kRaw}, {"masked", DepthInput::kMasked}, {"filled", DepthInput::kFilled}},
           "channels of the depth branch: depth; and validity; and a fill of the holes");
  b.choice("head", c.head, {{"direct", Head::kDirect}, {"gated", Head::kGated}},
           "last layer: depth, or a gated mix of depth and the corrected fill");
  b.field("depth_scale_m", c.depth_scale_m, "input depth is divided by this", positive());
  b.field("min_depth_m", c.min_depth_m, "smallest depth that can be predicted", positive());
  b.field("max_depth_m", c.max_depth_m, "largest depth that can be predicted", positive());
  b.choice("depth_kind", c.depth_kind,
           {{"plane", DepthKind::kPlane}, {"perspective", DepthKind::kPerspective}},
           "depth along the optical axis or along the ray, input and output alike");
  const std::string wrong = mistake(c);
  const std::size_t colon = wrong.find(": ");
  if (!wrong.empty()) b.check(wrong.substr(0, colon), false, "expected " + wrong.substr(colon + 2));
}

DepthCompletionNetImpl::DepthCompletionNetImpl(const DepthCompletionConfig& config) : config_(config) {
  if (const std::string wrong = mistake(config); !wrong.empty()) {
    throw std::invalid_argument("DepthCompletionNet: expected " + wrong);
  }
  const Normalization normalization = config.normalization;
  image_encoder_ =
      register_module("image_encoder", ResnetEncoder(3, config.image_widths, config.stem, normalization));
  depth_encoder_ = register_module(
      "depth_encoder",
      ResnetEncoder(depth_channels(config.depth_input), config.depth_widths, config.stem, normalization));
  const auto fused = [&](std::size_t stage) {
    return config.image_widths[stage] + (config.fusion == Fusion::kSum ? 0 : config.depth_widths[stage]);
  };
  // Skips, coarse to fine: stages 3, 2, 1 and the stem, which is as wide as stage 1; the last level has none.
  const std::vector<int> skips{fused(2), fused(1), fused(0), fused(0), 0};
  int below = fused(3);
  for (std::size_t i = 0; i < kDecoderLevels; ++i) {
    const std::string name = "decoder" + std::to_string(i + 1);
    decoder_.push_back(
        register_module(name, conv_block(below + skips[i], config.decoder_widths[i], 3, 1, normalization)));
    below = config.decoder_widths[i];
  }
  const int outputs = config.head == Head::kGated ? 3 : 1;
  head_ = register_module("head", torch::nn::Conv2d(torch::nn::Conv2dOptions(below, outputs, 3).padding(1)));
  torch::NoGradGuard no_grad;
  head_->weight.mul_(0.1);  // the first predictions lie near the middle of the range, not anywhere in it
  head_->bias.zero_();
}

std::vector<torch::Tensor> DepthCompletionNetImpl::encode_image(const torch::Tensor& image) {
  check_shape(image, 3, "image [B,3,H,W]");
  return image_encoder_->forward(pad(image, encoder_stride(config_.stem), true));
}

std::vector<torch::Tensor> DepthCompletionNetImpl::encode_depth(const torch::Tensor& sparse_m) {
  check_shape(sparse_m, 1, "sparse_m [B,1,H,W]");
  std::vector<torch::Tensor> channels{sparse_m / config_.depth_scale_m};
  if (config_.depth_input != DepthInput::kRaw) channels.push_back((sparse_m > 0).to(sparse_m.dtype()));
  if (config_.depth_input == DepthInput::kFilled) {
    const SparseFill fill = fill_pyramid(to_log_share(sparse_m, config_), channels[1]);
    channels.push_back(fill.value);
    channels.push_back(fill.coarseness);
  }
  std::vector<torch::Tensor> pyramid{torch::cat(channels, 1)};  // [B,C,H,W]
  for (torch::Tensor& map : depth_encoder_->forward(pad(pyramid[0], encoder_stride(config_.stem), false))) {
    pyramid.push_back(std::move(map));
  }
  return pyramid;
}

torch::Tensor DepthCompletionNetImpl::decode(const std::vector<torch::Tensor>& image_pyramid,
                                             const std::vector<torch::Tensor>& depth_pyramid) {
  if (image_pyramid.size() != kDecoderLevels || depth_pyramid.size() != kDecoderLevels + 1 ||
      image_pyramid[0].sizes().slice(2) != depth_pyramid[1].sizes().slice(2)) {
    throw std::invalid_argument(
        "DepthCompletionNet: decode needs the pyramids of images and depths of one size");
  }
  const auto fused = [&](std::size_t level) {
    const torch::Tensor& image = image_pyramid[level];
    const torch::Tensor& depth = depth_pyramid[level + 1];
    return config_.fusion == Fusion::kSum ? image + depth : torch::cat({image, depth}, 1);
  };
  torch::Tensor x = fused(kDecoderLevels - 1);  // [B,w3,H/32,W/32]
  for (std::size_t i = 0; i + 1 < kDecoderLevels; ++i) {
    const torch::Tensor skip = fused(kDecoderLevels - 2 - i);
    x = decoder_[i]->forward(torch::cat({enlarge_to(x, skip.size(2), skip.size(3)), skip}, 1));
  }
  const std::int64_t full = config_.stem == Stem::kDownsample ? 2 : 1;
  x = decoder_.back()->forward(enlarge_to(x, x.size(2) * full, x.size(3) * full));  // [B,d4,H,W], padded
  const torch::Tensor raw = head_->forward(x);
  return to_depth(raw.narrow(2, 0, depth_pyramid[0].size(2)).narrow(3, 0, depth_pyramid[0].size(3)),
                  depth_pyramid[0]);
}

torch::Tensor DepthCompletionNetImpl::to_depth(const torch::Tensor& raw,
                                               const torch::Tensor& depth_input) const {
  torch::Tensor share = torch::sigmoid(raw.narrow(1, 0, 1));
  if (config_.head == Head::kGated) {
    const torch::Tensor any = depth_input.narrow(1, 1, 1).amax({2, 3}, /*keepdim=*/true);  // [B,1,1,1] 0 or 1
    const torch::Tensor gate = torch::sigmoid(raw.narrow(1, 1, 1)) * any;
    const torch::Tensor residual = kLargestResidual * torch::tanh(raw.narrow(1, 2, 1));
    const torch::Tensor corrected = (depth_input.narrow(1, 2, 1) + residual).clamp(0, 1);
    share = share + gate * (corrected - share);
  }
  return config_.min_depth_m * torch::exp(share * std::log(config_.max_depth_m / config_.min_depth_m));
}

torch::Tensor DepthCompletionNetImpl::forward(const torch::Tensor& image, const torch::Tensor& sparse_m) {
  return decode(encode_image(image), encode_depth(sparse_m));
}

}  // namespace alight
