#include "train/network_pass.hpp"

#include <limits>

#include "models/depth_conversion.hpp"
#include "models/inputs/altitude_plane.hpp"

namespace alight {

SceneView scene_view(const Batch& batch, const torch::Tensor& image, const torch::Tensor& right,
                     const torch::Tensor& knows_height, const DepthCompletionConfig& config) {
  const torch::Tensor unknown = torch::full_like(batch.height_m, std::numeric_limits<float>::quiet_NaN());
  const torch::Tensor plane_m =
      altitude_planes(torch::where(knows_height, batch.height_m, unknown), batch.down_camera,
                      batch.intrinsics_px, image.size(2), image.size(3), config.max_depth_m);
  return {image, right, to_network_depth(plane_m, batch.intrinsics_px, config.depth_kind),
          batch.intrinsics_px.select(1, 0) * batch.baseline_m};
}

torch::Tensor predict(DepthCompletionNet net, const Batch& batch, const NetworkInput& input) {
  const DepthCompletionConfig& config = net->config();
  const SceneView view = scene_view(batch, input.image, input.right, input.knows_height, config);
  const torch::Tensor sparse = to_network_depth(input.sparse_m, batch.intrinsics_px, config.depth_kind);
  return from_network_depth(net->forward(view, sparse), batch.intrinsics_px, config.depth_kind);
}

LossInputs loss_inputs(const Batch& batch, const NetworkInput& input, const torch::Tensor& prediction_m,
                       const torch::Tensor& ground_truth_m) {
  LossInputs inputs;
  inputs.prediction_m = prediction_m;
  inputs.ground_truth_m = ground_truth_m;
  inputs.input_m = input.sparse_m;
  inputs.left = batch.left;
  inputs.previous = batch.previous;
  inputs.next = batch.next;
  inputs.right = batch.right;
  inputs.has_previous = batch.has_previous;
  inputs.has_next = batch.has_next;
  inputs.has_right = batch.has_right;
  inputs.T_previous_camera = batch.T_previous_camera;
  inputs.T_next_camera = batch.T_next_camera;
  inputs.baseline_m = batch.baseline_m;
  inputs.intrinsics_px = batch.intrinsics_px;
  return inputs;
}

}  // namespace alight
