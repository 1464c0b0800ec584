#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/models/tiny_net.hpp"
#include "train/export/exported_part.hpp"

namespace alight::test {

/// Sizes that are no multiple of the encoder's stride.
constexpr ExportSize kExportSize{45, 75};

struct ExportVariant {
  const char* name;
  DepthCompletionConfig config;
};

inline void PrintTo(const ExportVariant& variant, std::ostream* out) { *out << variant.name; }

inline std::vector<ExportVariant> export_variants() {
  DepthCompletionConfig clamped = tiny_config();
  clamped.min_depth_m = 8;  // so near each other that both limits are reached
  clamped.max_depth_m = 15;
  DepthCompletionConfig masked = tiny_config();
  masked.stem = Stem::kFull;
  masked.fusion = Fusion::kSum;
  masked.depth_input = DepthInput::kMasked;
  masked.head = Head::kDirect;
  DepthCompletionConfig group = tiny_shipped_config();
  group.normalization = Normalization::kGroup;
  return {{"Default", tiny_config()},     {"Clamped", clamped},          {"Shipped", tiny_shipped_config()},
          {"Paper", tiny_paper_config()}, {"FullStemMaskedSum", masked}, {"GroupNormalization", group}};
}

/// What the network computes, step by step.
struct Reference {
  torch::Tensor image;
  torch::Tensor depth;
  std::vector<torch::Tensor> image_features;
  torch::Tensor depth_m;
};

/// @param with_points false: a sparse map without any point
inline Reference reference(DepthCompletionNet net, bool with_points) {
  torch::NoGradGuard no_grad;
  const SceneView view = random_view(1, kExportSize.height_px, kExportSize.width_px);
  torch::Tensor sparse_m = random_sparse_m(1, kExportSize.height_px, kExportSize.width_px);
  if (!with_points) sparse_m.zero_();
  Reference r;
  r.image = net->image_input(view);
  r.depth = net->depth_input(sparse_m, view.prior_m);
  r.image_features = net->image_features(r.image);
  r.depth_m = net->forward(view, sparse_m);
  return r;
}

/// Named inputs of one exported part.
using NamedTensors = std::vector<std::pair<std::string, torch::Tensor>>;

inline NamedTensors inputs_of(const Reference& r, const DepthCompletionConfig& config, ExportedPart part) {
  if (part == ExportedPart::kImageEncoder) return {{"image", r.image}};
  if (part == ExportedPart::kWhole) return {{"image", r.image}, {"depth", r.depth}};
  NamedTensors inputs;
  if (config.detail_width > 0) inputs.emplace_back("image", r.image);
  for (int i = 0; i < kFeatureMaps; ++i) {
    inputs.emplace_back(feature_name(i), r.image_features[static_cast<std::size_t>(i)]);
  }
  inputs.emplace_back("depth", r.depth);
  return inputs;
}

/// Largest difference over the largest value: features may be 0.
inline double relative_error(const torch::Tensor& actual, const torch::Tensor& expected) {
  return ((actual - expected).abs().max() / expected.abs().max()).item<double>();
}

}  // namespace alight::test
