#pragma once

#include <filesystem>
#include <memory>

#include "geometry/stereo_rectification.hpp"
#include "infer/depth_predictor.hpp"

namespace alight {

/// DepthCompletionNet behind the engine's interface: evaluation mode, no gradients, plane depth in and out whatever the
/// network's `depth_kind`. This header is free of torch.
/// @param checkpoint file of train's save_checkpoint. @param rig of the images that will come (rectified, after the crop)
/// @param threads 0: all of the machine's. @throws DataError as load_network
std::unique_ptr<DepthPredictor> make_network_predictor(const std::filesystem::path& checkpoint,
                                                       const RectifiedRig& rig, int threads);

}  // namespace alight
