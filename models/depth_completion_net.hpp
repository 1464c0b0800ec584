#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"
#include "models/inputs/scene_view.hpp"
#include "models/layers/convolution.hpp"
#include "models/resnet_encoder.hpp"

namespace alight {

/// How the two pyramids meet before every scale of the decoder (paper 3.2, "late fusion").
enum class Fusion { kConcatenate, kSum };

/// What the depth branch sees. `raw`: one channel, depth / depth_scale_m, 0 where missing (the paper).
/// `masked`: that and a validity channel. `filled`: everything relative to the prior, so that the flight's height
/// cancels: ln(depth / prior), validity, ln(fill / prior) of the holes' fill (models/inputs/sparse_fill.hpp), the fill's
/// coarseness, and ln(prior / depth_scale_m).
enum class DepthInput { kRaw, kMasked, kFilled };

/// What the decoder's last layer means. `direct`: the depth (the paper). `gated`: a correction of the prior, a
/// correction of the fill of the sparse input, and a gate that mixes the two, so that neither the flight's height nor
/// interpolation need be learned (METHOD, "The opponent").
enum class Head { kDirect, kGated };

/// What depth is before any point has come. `constant`: depth_scale_m. `altitude`: level ground at the height that the
/// vehicle reports; depth_scale_m where it reports none.
enum class Prior { kConstant, kAltitude };

/// Architecture of DepthCompletionNet. All of it is stored in a checkpoint.
struct DepthCompletionConfig {
  Stem stem = Stem::kDownsample;
  Normalization normalization = Normalization::kBatch;
  Fusion fusion = Fusion::kConcatenate;
  std::vector<int> image_widths{64, 128, 256, 512};
  std::vector<int> depth_widths{32, 64, 128, 256};
  std::vector<int> decoder_widths{128, 96, 64, 32, 16};
  DepthInput depth_input = DepthInput::kFilled;
  Head head = Head::kGated;
  Prior prior = Prior::kConstant;
  bool stereo =
      false;  ///< the image branch also sees what the right camera says (models/inputs/stereo_cue.hpp)
  int detail_width = 0;    ///< channels of a full-resolution layer on the inputs themselves; 0: none
  int fill_smoothing = 0;  ///< see fill_pyramid
  double depth_scale_m = 20.0;
  double min_depth_m = 0.5;
  double max_depth_m = 150.0;
  DepthKind depth_kind = DepthKind::kPlane;
};
void bind(Binder& b, DepthCompletionConfig& c);

/// Channels of the two normalised inputs.
int image_channels(const DepthCompletionConfig& config);
int depth_channels(DepthInput input);

/// Channels of the `filled` depth input, counted from 0.
namespace filled_input {
constexpr std::int64_t kValid = 1;
constexpr std::int64_t kFill = 2;
constexpr std::int64_t kPrior = 4;
}  // namespace filled_input

/// How far the gated head corrects, natural logarithms: a roof at a seventh of the flight's height is the limit.
constexpr double kLargestPriorCorrection = 2.0;
constexpr double kLargestFillCorrection = 0.5;

/// [0] a normalised input [B,C,H,W], then its features, fine to coarse: what the decoder takes.
std::vector<torch::Tensor> feature_pyramid(const torch::Tensor& input,
                                           const std::vector<torch::Tensor>& features);

/// ResNet-18 encoder-decoder for depth completion (paper 3.2; METHOD, "Network"). Image and sparse depth are
/// encoded separately, so that an image is encoded once and only the depth branch and the decoder run again
/// as points arrive:
///
///     const auto image_pyramid = net->encode_image(view);
///     for (...) depth_m = net->decode(image_pyramid, net->encode_depth(sparse_m, view.prior_m));
///
/// Any height and width: the input is padded to the encoder's stride inside and the output is cropped back.
/// Depth is of `config().depth_kind`, input and output alike; models/depth_conversion.hpp converts.
class DepthCompletionNetImpl : public torch::nn::Module {
 public:
  /// @throws std::invalid_argument for widths that do not fit together (`bind` reports the same as
  /// ConfigError)
  explicit DepthCompletionNetImpl(const DepthCompletionConfig& config = {});

  /// @returns [0] the normalised input [B,C,H,W], then features, fine to coarse; meant for decode() alone
  std::vector<torch::Tensor> encode_image(const SceneView& view);

  /// @param sparse_m [B,1,H,W] float32, metres, 0 = missing (all zero: no LiDAR) @param prior_m as SceneView's
  /// @returns [0] the normalised input [B,C,H,W], then features, fine to coarse; meant for decode() alone
  std::vector<torch::Tensor> encode_depth(const torch::Tensor& sparse_m, const torch::Tensor& prior_m = {});

  /// @returns [B,1,H,W] float32, metres, within [min_depth_m, max_depth_m], no holes. Direct: the layer's output x
  /// becomes min * (max / min)^sigmoid(x), so that equal steps are equal ratios of depth. Gated:
  /// ln(depth) = (1 - g) (ln(prior) + r) + g (ln(fill) + s), |r| <= 2, |s| <= 0.5, and g = 0 where the input has no
  /// point at all.
  torch::Tensor decode(const std::vector<torch::Tensor>& image_pyramid,
                       const std::vector<torch::Tensor>& depth_pyramid);

  /// The two encoders in steps: arithmetic without parameters makes the normalised input [B,C,H,W], then the learned
  /// part makes its five maps, fine to coarse. A pyramid is the one followed by the others.
  torch::Tensor image_input(const SceneView& view) const;
  torch::Tensor depth_input(const torch::Tensor& sparse_m, const torch::Tensor& prior_m = {}) const;
  std::vector<torch::Tensor> image_features(const torch::Tensor& image_input);
  std::vector<torch::Tensor> depth_features(const torch::Tensor& depth_input);

  /// decode(encode_image(view), encode_depth(sparse_m, view.prior_m))
  torch::Tensor forward(const SceneView& view, const torch::Tensor& sparse_m);

  /// The last layer on the decoder's finest map. @param x [B,C,H,W] @param depth_input of depth_input()
  /// @returns depth [B,1,H,W]
  torch::Tensor depth_of(const torch::Tensor& x, const torch::Tensor& depth_input);

  const DepthCompletionConfig& config() const { return config_; }

 private:
  DepthCompletionConfig config_;
  ResnetEncoder image_encoder_{nullptr};
  ResnetEncoder depth_encoder_{nullptr};
  std::vector<torch::nn::Sequential> decoder_;
  torch::nn::Sequential detail_{nullptr};  // null without detail_width
  Convolution head_{nullptr};
};
TORCH_MODULE(DepthCompletionNet);

}  // namespace alight
