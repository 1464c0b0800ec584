#include "models/depth_completion_net.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "foundation/config_reader.hpp"
#include "models/inputs/sparse_fill.hpp"
#include "models/inputs/stereo_cue.hpp"

namespace alight {
namespace {

namespace F = torch::nn::functional;
constexpr std::size_t kStages = 4;
constexpr std::size_t kDecoderLevels = 5;

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
  if (c.prior == Prior::kAltitude && c.head != Head::kGated) {
    return "prior: constant, or head: gated, because only the gated head corrects a prior";
  }
  if (c.stereo && (c.prior != Prior::kAltitude || c.depth_kind != DepthKind::kPlane)) {
    return "stereo: false, or prior: altitude and depth_kind: plane, because the right image is compared at "
           "the prior";
  }
  if (c.detail_width < 0) return "detail_width: 0 or more";
  return {};
}

/// Pads to a multiple of the encoder's stride, right and below, where decode() cuts.
torch::Tensor pad(const torch::Tensor& x, int stride, bool replicate) {
  const std::int64_t right = (stride - x.size(3) % stride) % stride;
  const std::int64_t below = (stride - x.size(2) % stride) % stride;
  if (right == 0 && below == 0) return x;
  auto options = F::PadFuncOptions({0, right, 0, below});
  if (!replicate) return F::pad(x, options);
  // LibTorch 1.13 replicates float32 alone on a processor.
  return F::pad(x.to(torch::kFloat32), options.mode(torch::kReplicate)).to(x.dtype());
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

/// The prior where there is one, depth_scale_m elsewhere. @param like [B,1,H,W]
torch::Tensor known_prior(const torch::Tensor& prior_m, const torch::Tensor& like,
                          const DepthCompletionConfig& c) {
  const torch::Tensor scale = torch::full_like(like, c.depth_scale_m);
  if (c.prior == Prior::kConstant || !prior_m.defined()) return scale;
  return torch::where(prior_m > 0, prior_m.clamp(c.min_depth_m, c.max_depth_m), scale);
}

}  // namespace

int depth_channels(DepthInput input) {
  return input == DepthInput::kRaw ? 1 : input == DepthInput::kMasked ? 2 : 5;
}

int image_channels(const DepthCompletionConfig& c) {
  return 3 + (c.stereo ? static_cast<int>(kStereoCueChannels) : 0);
}

void bind(Binder& b, DepthCompletionConfig& c) {
  b.choice("stem", c.stem, {{"downsample", Stem::kDownsample}, {"full", Stem::kFull}},
           "first layer: stride 2 and pooling, or full resolution");
  b.choice(
      "normalization", c.normalization,
      {{"batch", Normalization::kBatch}, {"group", Normalization::kGroup}, {"none", Normalization::kNone}},
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
           "last layer: depth, or a gated mix of the corrected prior and the corrected fill");
  b.choice("prior", c.prior, {{"constant", Prior::kConstant}, {"altitude", Prior::kAltitude}},
           "depth before any point: depth_scale_m, or level ground at the vehicle's height");
  b.field("stereo", c.stereo,
          "the image branch sees the parallax that the right camera leaves over the prior");
  b.field("detail_width", c.detail_width, "channels of a full-resolution layer on the inputs; 0: none",
          between(0, 1024));
  b.field("fill_smoothing", c.fill_smoothing, "smoothing passes at every level of the fill", between(0, 100));
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

std::vector<torch::Tensor> feature_pyramid(const torch::Tensor& input,
                                           const std::vector<torch::Tensor>& features) {
  std::vector<torch::Tensor> maps{input};
  maps.insert(maps.end(), features.begin(), features.end());
  return maps;
}

DepthCompletionNetImpl::DepthCompletionNetImpl(const DepthCompletionConfig& config) : config_(config) {
  if (const std::string wrong = mistake(config); !wrong.empty()) {
    throw std::invalid_argument("DepthCompletionNet: expected " + wrong);
  }
  const Normalization normalization = config.normalization;
  image_encoder_ = register_module("image_encoder", ResnetEncoder(image_channels(config), config.image_widths,
                                                                  config.stem, normalization));
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
  if (config.detail_width > 0) {
    detail_ = register_module("detail",
                              conv_block(below + image_channels(config) + depth_channels(config.depth_input),
                                         config.detail_width, 3, 1, normalization));
    below = config.detail_width;
  }
  const int outputs = config.head == Head::kGated ? 3 : 1;
  head_ = register_module("head", Convolution(torch::nn::Conv2dOptions(below, outputs, 3).padding(1)));
  torch::NoGradGuard no_grad;
  head_->weight.mul_(0.1);  // the first predictions lie near the middle of the range, not anywhere in it
  head_->bias.zero_();
}

torch::Tensor DepthCompletionNetImpl::image_input(const SceneView& view) const {
  check_shape(view.left, 3, "left [B,3,H,W]");
  if (!config_.stereo) return view.left;
  const torch::Tensor prior_m =
      view.prior_m.defined() ? view.prior_m : torch::zeros_like(view.left.narrow(1, 0, 1));
  const torch::Tensor right = view.right.defined() ? view.right : torch::zeros_like(view.left);
  const torch::Tensor focal_baseline_px_m = view.focal_baseline_px_m.defined()
                                                ? view.focal_baseline_px_m
                                                : torch::zeros({view.left.size(0)}, view.left.options());
  return torch::cat({view.left, stereo_cue(view.left, right, prior_m, focal_baseline_px_m)}, 1);
}

torch::Tensor DepthCompletionNetImpl::depth_input(const torch::Tensor& sparse_m,
                                                  const torch::Tensor& prior_m) const {
  check_shape(sparse_m, 1, "sparse_m [B,1,H,W]");
  if (config_.depth_input == DepthInput::kRaw) return sparse_m / config_.depth_scale_m;
  const torch::Tensor valid = (sparse_m > 0).to(sparse_m.dtype());
  if (config_.depth_input == DepthInput::kMasked)
    return torch::cat({sparse_m / config_.depth_scale_m, valid}, 1);
  const torch::Tensor prior = known_prior(prior_m, sparse_m, config_);
  const torch::Tensor relative =
      (sparse_m.clamp(config_.min_depth_m, config_.max_depth_m) / prior).log() * valid;
  const SparseFill fill = fill_pyramid(relative, valid, config_.fill_smoothing);
  return torch::cat({relative, valid, fill.value, fill.coarseness, (prior / config_.depth_scale_m).log()}, 1);
}

std::vector<torch::Tensor> DepthCompletionNetImpl::image_features(const torch::Tensor& image_input) {
  check_shape(image_input, image_channels(config_), "image_input [B,C,H,W]");
  return image_encoder_->forward(pad(image_input, encoder_stride(config_.stem), true));
}

std::vector<torch::Tensor> DepthCompletionNetImpl::depth_features(const torch::Tensor& depth_input) {
  check_shape(depth_input, depth_channels(config_.depth_input), "depth_input [B,C,H,W]");
  return depth_encoder_->forward(pad(depth_input, encoder_stride(config_.stem), false));
}

std::vector<torch::Tensor> DepthCompletionNetImpl::encode_image(const SceneView& view) {
  const torch::Tensor input = image_input(view);  // [B,C,H,W]
  return feature_pyramid(input, image_features(input));
}

std::vector<torch::Tensor> DepthCompletionNetImpl::encode_depth(const torch::Tensor& sparse_m,
                                                                const torch::Tensor& prior_m) {
  const torch::Tensor input = depth_input(sparse_m, prior_m);  // [B,C,H,W]
  return feature_pyramid(input, depth_features(input));
}

torch::Tensor DepthCompletionNetImpl::decode(const std::vector<torch::Tensor>& image_pyramid,
                                             const std::vector<torch::Tensor>& depth_pyramid) {
  if (image_pyramid.size() != kDecoderLevels + 1 || depth_pyramid.size() != kDecoderLevels + 1 ||
      image_pyramid[0].sizes().slice(2) != depth_pyramid[0].sizes().slice(2)) {
    throw std::invalid_argument(
        "DepthCompletionNet: decode needs the pyramids of images and depths of one size");
  }
  const auto fused = [&](std::size_t level) {
    const torch::Tensor& image = image_pyramid[level + 1];
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
  x = x.narrow(2, 0, depth_pyramid[0].size(2)).narrow(3, 0, depth_pyramid[0].size(3));
  if (detail_) {
    x = detail_->forward(torch::cat({x, image_pyramid[0].to(x.dtype()), depth_pyramid[0].to(x.dtype())}, 1));
  }
  return depth_of(x, depth_pyramid[0]);
}

torch::Tensor DepthCompletionNetImpl::depth_of(const torch::Tensor& x, const torch::Tensor& depth_input) {
  const torch::Tensor raw = head_->forward(x).to(torch::kFloat32);
  if (config_.head == Head::kDirect) {
    return config_.min_depth_m *
           torch::exp(torch::sigmoid(raw) * std::log(config_.max_depth_m / config_.min_depth_m));
  }
  const torch::Tensor any =
      depth_input.narrow(1, filled_input::kValid, 1).amax({2, 3}, /*keepdim=*/true);  // [B,1,1,1] 0 or 1
  const torch::Tensor gate = torch::sigmoid(raw.narrow(1, 1, 1)) * any;
  const torch::Tensor from_prior = kLargestPriorCorrection * torch::tanh(raw.narrow(1, 0, 1));
  const torch::Tensor from_fill = depth_input.narrow(1, filled_input::kFill, 1) +
                                  kLargestFillCorrection * torch::tanh(raw.narrow(1, 2, 1));
  const torch::Tensor relative = from_prior + gate * (from_fill - from_prior);
  return (config_.depth_scale_m * torch::exp(depth_input.narrow(1, filled_input::kPrior, 1) + relative))
      .clamp(config_.min_depth_m, config_.max_depth_m);
}

torch::Tensor DepthCompletionNetImpl::forward(const SceneView& view, const torch::Tensor& sparse_m) {
  return decode(encode_image(view), encode_depth(sparse_m, view.prior_m));
}

}  // namespace alight
