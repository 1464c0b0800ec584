#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "configs/config_reader.hpp"
#include "losses/training_loss.hpp"
#include "models/depth_completion_net.hpp"
#include "train/density_sampling.hpp"
#include "train/validation.hpp"

namespace alight {

/// The loop. Defaults: the paper's (3.2 and 4.1).
struct TrainingLoopConfig {
  std::vector<std::string> flights;  ///< empty: all that are not held out
  int epochs = 30;
  int batch_size = 16;
  int steps_per_epoch = 0;     ///< 0: as many as the samples give
  std::optional<int> crop_px;  ///< random square cut-outs; none: whole images
  double learning_rate = 2e-4;
  int drop_after_epoch = 20;  ///< learning rate times drop_factor from here on; 0: never
  double drop_factor = 0.1;
  int warmup_steps = 0;           ///< the learning rate rises linearly over the first steps
  double clip_gradient_norm = 0;  ///< 0: off
  std::int64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  int workers = 1;  ///< batches prepared in the background
  int cache_mb = 4000;
};
void bind(Binder& b, TrainingLoopConfig& c);

/// One file of configs/train.
struct TrainConfig {
  std::string dataset = "data/demo";
  DepthCompletionConfig model;
  TrainingLossConfig loss;
  DensitySamplingConfig density;
  TrainingLoopConfig train;
  ValidationConfig validation;
};
void bind(Binder& b, TrainConfig& c);

}  // namespace alight
