#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <torch/torch.h>

#include "models/depth_completion_net.hpp"

namespace alight {

/// Version of the file format that this program writes; older ones are read, newer ones refused.
constexpr std::int64_t kCheckpointVersion = 1;

/// What a checkpoint carries besides the network.
struct CheckpointInfo {
  std::int64_t epoch = 0;    ///< finished epochs
  std::int64_t step = 0;     ///< finished optimizer steps
  std::string train_config;  ///< resolved YAML of the training run, empty if unknown
};

/// A network read from disk, in eval mode.
struct LoadedNetwork {
  DepthCompletionNet net{nullptr};
  DepthCompletionConfig config;
  CheckpointInfo info;
};

/// Writes one file: format version, architecture (YAML), weights and buffers by name, `info`, and the state
/// of `adam` where given. The file appears whole or not at all (temporary name, then rename).
/// @throws DataError if it cannot be written
void save_checkpoint(const std::filesystem::path& path, DepthCompletionNet net,
                     const CheckpointInfo& info = {}, const torch::optim::Adam* adam = nullptr);

/// Reads a network; the architecture comes from the file.
/// @throws DataError: missing file, no checkpoint, newer version, tensors that do not fit the stated
/// architecture
LoadedNetwork load_network(const std::filesystem::path& path, torch::Device device = torch::kCPU);

/// Reads weights, and the optimizer's state where `adam` is given, into a network that exists (its parameters
/// must be those that `adam` optimises).
/// @throws DataError as load_network, and if the network is another one: names the first tensor that differs
/// and both shapes
CheckpointInfo load_checkpoint(const std::filesystem::path& path, DepthCompletionNet net,
                               torch::optim::Adam* adam = nullptr);

/// Copies an image encoder's weights into a network before its training: from another checkpoint, or from what
/// scripts/convert_resnet18.py makes of torchvision's ResNet-18. An encoder that saw fewer channels (no stereo) starts
/// with weights of 0 for those that the network sees besides.
/// @throws DataError as load_network, and if the encoders differ: names the first tensor and both shapes
void load_image_encoder(const std::filesystem::path& path, DepthCompletionNet net);

}  // namespace alight
