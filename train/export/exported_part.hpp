#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/depth_completion_net.hpp"

namespace alight {

/// What one exported file computes. All take and give the learned part's tensors: the arithmetic before it (stereo cue,
/// fill, prior: DepthCompletionNet's image_input() and depth_input()) has no parameters and stays with the caller.
/// `whole`: image, depth -> depth_m. `image_encoder`: image -> image_features_1 .. 5, once an image. `refinement`:
/// those, depth, and image where the network has a detail layer -> depth_m, again with every set of points.
enum class ExportedPart { kWhole, kImageEncoder, kRefinement };

/// Size of the exported network's inputs, fixed by the export; any, padding is part of the graph.
struct ExportSize {
  std::int64_t height_px = 0;
  std::int64_t width_px = 0;
};

/// Features that the image encoder hands to the refinement.
constexpr int kFeatureMaps = 5;
/// "image_features_1", fine, to "image_features_5", coarse.
std::string feature_name(int index_from_0);

/// The network that is written, in eval mode: a copy with batch normalisation folded, or, where there is none, itself.
DepthCompletionNet network_to_export(DepthCompletionNet net);

/// What a reader of the file has to know: "alight.model_config" (YAML), "alight.depth_kind", and a sentence an input
/// and output.
std::map<std::string, std::string> export_metadata(const DepthCompletionConfig& config);

}  // namespace alight
