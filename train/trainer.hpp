#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "models/checkpoint.hpp"
#include "models/depth_completion_net.hpp"
#include "train/data/batch.hpp"
#include "train/data/batch_loader.hpp"
#include "train/data/sample_cache.hpp"
#include "train/distributed/process_group.hpp"
#include "train/logging/run_folder.hpp"
#include "train/run_events.hpp"
#include "train/train_config.hpp"
#include "train/validation.hpp"

namespace alight {

/// Mixed-density training (paper 3.2 and 4.1). Same seed and number of threads: same weights, bit for bit, whether the
/// run was interrupted or not (float32).
///
/// Several processes share every batch: each learns from its part, gradients and losses are averaged, batch normalisation
/// sees the whole batch. That is the training of one process but for rounding, and but for samples without a pixel that
/// counts: a loss averages over the others of its part. Rank 0 alone validates and writes.
class Trainer {
 public:
  /// Sets torch's seed and threads and makes the network. @param validation held-out samples, or null
  /// @param group whose processes train together @throws ConfigError for a device that is not there, or a batch that
  /// cannot be shared, DataError as ProcessGroup
  Trainer(const TrainConfig& config, SampleSource& training, SampleSource* validation, RunFolder& folder,
          ProcessGroup group = {});

  /// Goes on where the run folder's last.pt stands; a run that never wrote one starts anew. Rows of metrics.csv that
  /// came after last.pt are dropped. @throws DataError as load_training
  void resume();

  /// All epochs that are left. Writes last.pt, best.pt (lowest ValidationReport::score_mm; without validation the last)
  /// and metrics.csv. @throws DataError naming step, samples and term if a loss is not finite
  void run();

  /// The best network on final_samples of the held-out samples; writes validation.txt. Empty without validation
  /// and on other processes than rank 0.
  std::optional<ValidationReport> evaluate_best();

  /// The pieces of run(), public so that the benchmark times them and no copy of them: the batches of an epoch, and one
  /// step of the optimizer on the mean gradient of the next optimizer.accumulate batches.
  BatchLoader loader(int epoch, std::size_t first_batch = 0);
  void train_step(const std::function<Batch()>& next_batch, int epoch, std::int64_t steps_an_epoch);

  /// The network that is saved to fly: the one that learns, or the average of its weights.
  DepthCompletionNet net() const { return flying_; }

 private:
  /// Means of the loss terms over batches, before weighting: depth, ratio, photometric, smoothness, total.
  using Losses = std::vector<double>;

  std::int64_t steps_per_epoch();
  void train_epoch(int epoch);
  LossTerms losses_of(const Batch& batch, std::int64_t place);
  void check_finite(const LossTerms& terms, const Batch& batch) const;
  void finish_epoch(int epoch, double seconds);
  void write_metrics(int epoch, const std::optional<ValidationReport>& report, double seconds);
  void open_events();
  void write_events(const std::vector<std::string>& names, const std::vector<double>& values);
  std::optional<ValidationReport> validate_epoch();
  void save(const std::string& name);
  bool writes() const { return group_.rank() == 0; }
  Losses mean_losses() const;

  TrainConfig config_;
  ProcessGroup group_;
  torch::Device device_;
  SampleCache cache_;
  SampleSource* validation_;
  RunFolder& folder_;
  DepthCompletionNet net_{nullptr};
  DepthCompletionNet flying_{nullptr};  // net_ itself, or the average of its weights
  std::optional<Optimizer> optimizer_;
  double learning_rate_ = 0;
  CheckpointInfo progress_;
  std::optional<RunEvents> events_;
};

}  // namespace alight
