#pragma once

#include <filesystem>
#include <optional>

#include <torch/torch.h>

#include "foundation/errors.hpp"
#include "infer/replay/network_config.hpp"
#include "models/depth_completion_net.hpp"
#include "models/split_decoder.hpp"

namespace alight {

/// A trained network made ready to fly: evaluation mode, no gradients, batch normalisation folded into the convolutions,
/// weights on their device, in their type and channels-last, decoder split into the image's part and the rest. Tracing and freezing it as TorchScript, with or without
/// fusion, was measured to gain nothing over this.
struct OnboardNetwork {
  DepthCompletionNet net{nullptr};
  std::optional<SplitDecoder> decoder;
  torch::Device device = torch::kCPU;
  torch::Dtype type = torch::kFloat32;

  /// An input of the learned part as its convolutions want it.
  torch::Tensor prepare(const torch::Tensor& x) const {
    return x.to(device, type).contiguous(torch::MemoryFormat::ChannelsLast);
  }
};

/// Sets torch's threads, too. @throws DataError as load_network, ConfigError for a device that is not there or a precision
/// that it does not have
OnboardNetwork load_onboard_network(const std::filesystem::path& checkpoint, const NetworkConfig& config);

}  // namespace alight
