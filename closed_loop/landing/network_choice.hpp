#pragma once

#include <memory>

#include "closed_loop/landing/land_config.hpp"
#include "infer/depth/depth_predictor.hpp"

namespace alight::closed_loop {

/// The network that a landing flies with. @param lidar_only none: null. @throws ConfigError if there is none, or this
/// build has no LibTorch
std::shared_ptr<DepthPredictor> choose_network(const LandConfig& config, bool lidar_only);

}  // namespace alight::closed_loop
