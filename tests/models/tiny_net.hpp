#pragma once

#include "models/depth_completion_net.hpp"

namespace alight::test {

/// The smallest network with all parts.
inline DepthCompletionConfig tiny_config() {
  DepthCompletionConfig config;
  config.image_widths = {4, 4, 8, 8};
  config.depth_widths = {4, 4, 8, 8};
  config.decoder_widths = {8, 4, 4, 4, 4};
  return config;
}

/// The smallest with all that the shipped network has: both cameras, the flight's height, a layer on the inputs.
inline DepthCompletionConfig tiny_shipped_config() {
  DepthCompletionConfig config = tiny_config();
  config.prior = Prior::kAltitude;
  config.stereo = true;
  config.detail_width = 4;
  config.fill_smoothing = 2;
  return config;
}

/// The paper's network at small widths.
inline DepthCompletionConfig tiny_paper_config() {
  DepthCompletionConfig config = tiny_config();
  config.depth_input = DepthInput::kRaw;
  config.head = Head::kDirect;
  config.depth_kind = DepthKind::kPerspective;
  return config;
}

/// Depth of 5..25 m at about a fifth of the pixels. @returns [batch,1,height,width]
inline torch::Tensor random_sparse_m(std::int64_t batch, std::int64_t height, std::int64_t width) {
  const torch::Tensor depth_m = 5 + 20 * torch::rand({batch, 1, height, width});
  return depth_m * (torch::rand_like(depth_m) < 0.2).to(depth_m.dtype());
}

/// Both cameras, a height and a baseline.
inline SceneView random_view(std::int64_t batch, std::int64_t height, std::int64_t width) {
  SceneView view{torch::rand({batch, 3, height, width}), torch::rand({batch, 3, height, width})};
  view.prior_m = 5 + 20 * torch::rand({batch, 1, height, width});
  view.focal_baseline_px_m = torch::full({batch}, 35.0);
  return view;
}

/// A network in eval mode that, other than a new one, has no parameter or running statistic at its starting value, and
/// whose depth depends on all of them strongly.
inline DepthCompletionNet random_net(const DepthCompletionConfig& config) {
  torch::manual_seed(11);
  DepthCompletionNet net(config);
  torch::NoGradGuard no_grad;
  for (auto& item : net->named_parameters()) {
    const bool norm = item.key().find(".norm.") != std::string::npos;
    if (norm) item.value().add_(0.3 * torch::randn_like(item.value()));
    if (item.key() == "head.weight") item.value().mul_(5);
    if (item.key() == "head.bias") item.value().add_(0.2 * torch::randn_like(item.value()));
  }
  for (int i = 0; i < 20; ++i) net->forward(random_view(2, 64, 64), random_sparse_m(2, 64, 64));
  net->eval();
  return net;
}

}  // namespace alight::test
