#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "models/depth_completion_net.hpp"
#include "train/batch.hpp"
#include "train/run_folder.hpp"
#include "train/sample_cache.hpp"
#include "train/train_config.hpp"
#include "train/validation.hpp"

namespace alight {

/// Means of the loss terms over an epoch, before weighting.
struct EpochLosses {
  double depth = 0;
  double ratio = 0;
  double photometric = 0;
  double smoothness = 0;
  double total = 0;
};

/// Factor of the learning rate at a step (paper 4.1: a tenth after epoch 20).
/// @param epoch from 1 @param step steps finished before this one
double learning_rate_factor(const TrainingLoopConfig& config, int epoch, std::int64_t step);

/// Mixed-density training (paper 3.2 and 4.1). Same seed and number of threads: same weights, bit for bit.
class Trainer {
 public:
  /// Sets torch's seed and threads and makes the network. @param validation held-out samples, or null
  Trainer(const TrainConfig& config, SampleSource& training, SampleSource* validation, RunFolder& folder);

  /// All epochs. Writes last.pt, best.pt (lowest ValidationReport::score_mm; without validation the last) and
  /// metrics.csv. @throws DataError naming step and term if a loss is not finite
  void run();

  /// The best network on final_samples of the held-out flights; writes validation.txt. Empty without
  /// validation.
  std::optional<ValidationReport> evaluate_best();

  DepthCompletionNet net() const { return net_; }

 private:
  EpochLosses train_epoch(int epoch);
  LossTerms train_step(const Batch& batch);
  LossTerms losses_of(const Batch& batch);
  void finish_epoch(int epoch, const EpochLosses& losses, double seconds);
  std::optional<ValidationReport> validate_epoch();
  void save(const std::string& name, int epoch) const;

  TrainConfig config_;
  SampleCache cache_;
  SampleSource* validation_;
  RunFolder& folder_;
  DepthCompletionNet net_{nullptr};
  std::optional<torch::optim::Adam> adam_;
  std::int64_t step_ = 0;
  std::optional<double> best_score_mm_;
};

}  // namespace alight
