#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "foundation/errors.hpp"
#include "models/depth_completion_net.hpp"

namespace alight {

/// Version of the file format that this program writes and reads. 1 had networks without a prior.
constexpr std::int64_t kCheckpointVersion = 2;

/// What a checkpoint carries besides the network.
struct CheckpointInfo {
  std::int64_t epoch = 0;            ///< finished epochs
  std::int64_t step = 0;             ///< finished optimizer steps
  std::string train_config;          ///< resolved YAML of the training run, empty if unknown
  std::int64_t epoch_step = 0;       ///< steps of the epoch that is not finished
  std::vector<double> epoch_losses;  ///< sums over the batches of the epoch that is not finished
  double best_score = std::numeric_limits<double>::infinity();  ///< of the validation so far
  std::int64_t best_epoch = 0;                                  ///< 0: none yet
};

/// A network read from disk, in eval mode.
struct LoadedNetwork {
  DepthCompletionNet net{nullptr};
  DepthCompletionConfig config;
  CheckpointInfo info;
};

/// What a run needs to go on, besides the network that flies.
struct TrainingState {
  DepthCompletionNet net{
      nullptr};  ///< the network that learns: not the one that flies, where that is an average
  torch::optim::Adam* adam = nullptr;  ///< optimises net's parameters
};

/// Writes one file: format version, architecture (YAML), weights and buffers by name, `info`, and the training state
/// where given. The file appears whole or not at all (temporary name, then rename).
/// @param net the one that flies @throws DataError if it cannot be written
void save_checkpoint(const std::filesystem::path& path, DepthCompletionNet net,
                     const CheckpointInfo& info = {}, const TrainingState& training = {});

/// The network alone for passing on: convolutions in half precision (2^-11 relative), the rest as it is; a sixth of a
/// training run's checkpoint. load_network reads it as any other. @throws DataError if it cannot be written
void save_network(const std::filesystem::path& path, DepthCompletionNet net, const CheckpointInfo& info = {});

/// Reads a network; the architecture comes from the file.
/// @throws DataError: missing file, no checkpoint, newer version, tensors that do not fit the stated
/// architecture
LoadedNetwork load_network(const std::filesystem::path& path, torch::Device device = torch::kCPU);

/// Reads weights into a network that exists.
/// @throws DataError as load_network, and if the network is another one: names the first tensor that differs
/// and both shapes
CheckpointInfo load_checkpoint(const std::filesystem::path& path, DepthCompletionNet net);

/// Reads back all that save_checkpoint wrote of a run: `net` flies, training.net learns.
/// @throws DataError as load_checkpoint, and if the file holds no training state
CheckpointInfo load_training(const std::filesystem::path& path, DepthCompletionNet net,
                             const TrainingState& training);

/// Copies an image encoder's weights into a network before its training: from another checkpoint, or from what
/// scripts/peers/convert_resnet18.py makes of torchvision's ResNet-18. An encoder that saw fewer channels (no stereo) starts
/// with weights of 0 for those that the network sees besides.
/// @throws DataError as load_network, and if the encoders differ: names the first tensor and both shapes
void load_image_encoder(const std::filesystem::path& path, DepthCompletionNet net);

}  // namespace alight
