#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/depth_completion_net.hpp"

namespace alight {

/// One convolution as it ran.
struct LayerCost {
  std::string part;    ///< "image_encoder", "depth_encoder" or "decoder": what runs again with new points
  std::string name;    ///< of its weight, such as "image_encoder.stem.conv"
  std::string output;  ///< shape, such as "[1, 64, 176, 176]"
  std::int64_t parameters = 0;
  double gflop = 0;  ///< a multiplication and an addition are two operations
};

/// Runs one forward pass of a height x width image and records every convolution in it; normalisation,
/// pooling and enlarging (a few percent) are not counted.
std::vector<LayerCost> measure_layers(DepthCompletionNet net, std::int64_t height_px, std::int64_t width_px);

/// A table of the layers, the sum of each part and of the whole, and the number of all parameters.
std::string describe_network(DepthCompletionNet net, std::int64_t height_px, std::int64_t width_px);

}  // namespace alight
