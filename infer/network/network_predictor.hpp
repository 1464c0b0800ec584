#pragma once

#include <filesystem>
#include <memory>

#include "geometry/rig/stereo_rectification.hpp"
#include "infer/depth/depth_predictor.hpp"
#include "infer/replay/network_config.hpp"

namespace alight {

/// DepthCompletionNet behind the engine's interface: evaluation mode, no gradients, plane depth in and out whatever the
/// network's `depth_kind`. Batch normalisation is folded into the convolutions, which run channels-last, the order that
/// measures fastest here; what is done to depth before and after them stays float32. The first images are as fast as
/// the others: it has warmed up when this returns. This header is free of torch.
/// @param checkpoint file of train's save_checkpoint. @param rig of the images that will come (rectified, after the crop)
/// @throws DataError as load_network, ConfigError for a device that is not there or a precision that it does not have
std::unique_ptr<DepthPredictor> make_network_predictor(const std::filesystem::path& checkpoint,
                                                       const RectifiedRig& rig,
                                                       const NetworkConfig& config = {});

}  // namespace alight
