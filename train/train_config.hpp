#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"
#include "losses/training_loss.hpp"
#include "models/depth_completion_net.hpp"
#include "train/compute.hpp"
#include "train/data/augmentation.hpp"
#include "train/data/density_sampling.hpp"
#include "train/data/occlusion_filter.hpp"
#include "train/data/split.hpp"
#include "train/optimizer.hpp"
#include "train/schedule.hpp"
#include "train/validation.hpp"

namespace alight {

/// The loop. Defaults: the paper's (3.2 and 4.1).
struct TrainingLoopConfig {
  int epochs = 30;
  int batch_size = 16;
  int steps_per_epoch = 0;     ///< 0: as many as the samples give
  std::optional<int> crop_px;  ///< random square cut-outs; none: whole images
  std::int64_t seed = 1;
  int workers = 1;  ///< batches prepared in the background
  int cache_mb = 4000;
  int save_every_steps = 0;   ///< last.pt also inside an epoch; 0: at its end
  int keep_every_epochs = 0;  ///< epoch_0010.pt and so on; 0: none
  int early_stop_epochs = 0;  ///< without a better validation; 0: never
  std::optional<std::string>
      image_encoder_weights;  ///< file of scripts/peers/convert_resnet18.py, or a checkpoint
};
void bind(Binder& b, TrainingLoopConfig& c);

/// One file of configs/train.
struct TrainConfig {
  std::string dataset = "data/demo";
  SplitConfig split;
  DepthCompletionConfig model;
  TrainingLossConfig loss;
  OcclusionFilterConfig occlusion_filter;
  AugmentationConfig augmentation;
  DensitySamplingConfig density;
  OptimizerConfig optimizer;
  ScheduleConfig schedule;
  ComputeConfig compute;
  TrainingLoopConfig train;
  ValidationConfig validation;
};
void bind(Binder& b, TrainConfig& c);

}  // namespace alight
