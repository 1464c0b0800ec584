#pragma once

#include <string>
#include <vector>

#include "train/data/sample_source.hpp"
#include "train/train_config.hpp"

namespace alight {

/// Median and range of a measured series.
struct Spread {
  double min = 0;
  double median = 0;
  double max = 0;
};

/// @throws std::invalid_argument if empty
Spread spread_of(std::vector<double> values);

/// How fast a configuration trains on this machine.
struct TrainingBenchmark {
  Spread
      loading_images_per_s;  ///< a batch of the loader every step, samples read and decoded in the background
  Spread fixed_images_per_s;  ///< the same batch every step
  double peak_memory_mb = 0;  ///< most resident memory of the process, megabytes (1e6 bytes)
  double network_gflop = 0;   ///< convolutions of one image's forward pass at the training's size
  Spread
      convolution_gflop_per_s;  ///< what this machine reaches in one large convolution, forward and backward

  /// Of the convolution's speed, what the fixed batch's steps reach; a step counts as three forward passes.
  double convolution_share() const;
  /// For people.
  std::string table() const;
  /// One line for programs.
  std::string json() const;
};

/// Speed of a 3x3 convolution, 64 -> 64 channels, 8 images of 88 x 88, channels last, forward and both gradients, with
/// the threads that are set. @param runs that are timed, after two that are not
Spread convolution_gflop_per_s(Precision precision, torch::Device device, int runs);

/// Times `steps` steps of the Trainer with loading and as many without, each after two that are not timed. Weights move,
/// nothing is kept. @throws std::invalid_argument for less than one step; else as Trainer
TrainingBenchmark benchmark_training(const TrainConfig& config, SampleSource& training, int steps);

}  // namespace alight
