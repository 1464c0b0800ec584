#pragma once

#include <filesystem>
#include <memory>

#include "geometry/rig/rig.hpp"
#include "infer/depth/depth_predictor.hpp"
#include "infer/replay/replay.hpp"

namespace alight {

/// The file of the network that the configuration names, or of the one that comes with the program.
/// @throws ConfigError if there is none
std::filesystem::path chosen_network(const ReplayConfig& config);

/// That network.
/// @param lidar_only no network: null. @throws ConfigError if there is none, and as make_network_predictor
std::shared_ptr<DepthPredictor> make_chosen_predictor(const ReplayConfig& config, const Rig& rig,
                                                      bool lidar_only);

}  // namespace alight
