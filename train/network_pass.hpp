#pragma once

#include "losses/training_loss.hpp"
#include "models/depth_completion_net.hpp"
#include "train/data/batch.hpp"
#include "train/data/density_sampling.hpp"

namespace alight {

/// What the network is shown of a batch before its points: both cameras, and the altitude plane where the height is known.
/// @param knows_height [B] bool
SceneView scene_view(const Batch& batch, const torch::Tensor& image, const torch::Tensor& right,
                     const torch::Tensor& knows_height, const DepthCompletionConfig& config);

/// The network's plane depth for what was drawn of a batch. @returns [B,1,H,W] float32, metres
torch::Tensor predict(DepthCompletionNet net, const Batch& batch, const NetworkInput& input);

/// What the losses see of it. @param ground_truth_m [B,1,H,W] the points of the full window that are trusted
LossInputs loss_inputs(const Batch& batch, const NetworkInput& input, const torch::Tensor& prediction_m,
                       const torch::Tensor& ground_truth_m);

}  // namespace alight
