#include "train/export/exported_part.hpp"

#include "foundation/config_reader.hpp"
#include "models/fold_batch_norm.hpp"

namespace alight {
namespace {

std::string image_text(const DepthCompletionConfig& c) {
  const std::string text =
      "[1," + std::to_string(image_channels(c)) + ",H,W] float32: left image, RGB in 0..1";
  return c.stereo
             ? text +
                   "; then the stereo cue, three scales of estimate and weight (models/inputs/stereo_cue.hpp)"
             : text;
}

std::string depth_text(const DepthCompletionConfig& c) {
  const std::string text = "[1," + std::to_string(depth_channels(c.depth_input)) + ",H,W] float32: ";
  if (c.depth_input == DepthInput::kRaw) return text + "sparse depth / depth_scale_m, 0 = missing";
  if (c.depth_input == DepthInput::kMasked) {
    return text + "sparse depth / depth_scale_m, 0 = missing; 1 where there is a point, else 0";
  }
  return text +
         "ln(sparse depth / prior), 0 = missing; 1 where there is a point, else 0; fill of the first; the " +
         "fill's coarseness 0..1 (models/inputs/sparse_fill.hpp); ln(prior / depth_scale_m)";
}

}  // namespace

std::string feature_name(int index_from_0) { return "image_features_" + std::to_string(index_from_0 + 1); }

DepthCompletionNet network_to_export(DepthCompletionNet net) {
  if (net->config().normalization == Normalization::kGroup) {
    net->eval();
    return net;
  }
  return fold_batch_norm(net);
}

std::map<std::string, std::string> export_metadata(const DepthCompletionConfig& config) {
  return {{"alight.model_config", print_config(config)},
          {"alight.depth_kind", config.depth_kind == DepthKind::kPlane ? "plane" : "perspective"},
          {"alight.image", image_text(config)},
          {"alight.depth", depth_text(config)},
          {"alight.depth_m", "[1,1,H,W] float32: metres, no holes"}};
}

}  // namespace alight
