#pragma once

#include <memory>
#include <string>

#include "models/checkpoint.hpp"
#include "train/evaluation/methods/depth_method.hpp"

namespace alight {

/// A trained network, on the CPU.
std::unique_ptr<DepthMethod> make_network_method(std::string name, LoadedNetwork network);

}  // namespace alight
