#include "train/benchmark.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/network_summary.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/train/data/memory_source.hpp"

namespace alight {
namespace {

using testing::HasSubstr;

TEST(Spread, IsMedianAndRange) {
  const Spread odd = spread_of({3, 1, 10});
  EXPECT_EQ(odd.min, 1);
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.max, 10);
  EXPECT_EQ(spread_of({4, 1, 10, 2}).median, 3);
  EXPECT_THROW(spread_of({}), std::invalid_argument);
}

TEST(TrainingBenchmark, ShareCountsAStepAsThreeForwardPasses) {
  TrainingBenchmark result;
  result.network_gflop = 2;
  result.fixed_images_per_s = {4, 5, 6};
  result.convolution_gflop_per_s = {50, 60, 70};
  EXPECT_DOUBLE_EQ(result.convolution_share(), 0.5);
  EXPECT_THAT(result.table(), HasSubstr("50.0  % of the convolution's speed"));
  EXPECT_THAT(result.json(), HasSubstr("\"fixed_images_per_s\": {\"min\": 4, \"median\": 5, \"max\": 6}"));
  EXPECT_THAT(result.json(), HasSubstr("\"convolution_share\": 0.5}"));
}

TrainConfig timed_training() {
  TrainConfig config;
  config.model = test::tiny_config();
  config.train.batch_size = 2;
  config.train.crop_px = 40;
  config.compute.threads = 1;
  return config;
}

TEST(TrainingBenchmark, MeasuresTheTrainersSteps) {
  const TrainConfig config = timed_training();
  test::MemorySource training = test::scenes(3);
  const TrainingBenchmark result = benchmark_training(config, training, 2);
  EXPECT_GT(result.loading_images_per_s.min, 0);
  EXPECT_GE(result.fixed_images_per_s.max, result.fixed_images_per_s.median);
  EXPECT_GT(result.fixed_images_per_s.min, 0);
  EXPECT_GT(result.peak_memory_mb, 50);  // LibTorch alone takes more
  EXPECT_GT(result.convolution_gflop_per_s.min, 0);
  double gflop = 0;
  for (const LayerCost& layer : measure_layers(DepthCompletionNet(config.model), 40, 40))
    gflop += layer.gflop;
  EXPECT_DOUBLE_EQ(result.network_gflop, gflop);
}

/// Counts who asks: a benchmark with loading reads other samples every step.
class CountingSource : public test::MemorySource {
 public:
  using test::MemorySource::MemorySource;
  DepthSample get(std::size_t index) override {
    ++reads;
    return test::MemorySource::get(index);
  }
  std::atomic<int> reads{0};
};

TEST(TrainingBenchmark, LoadsOneBatchAStepAndAccumulatedBatch) {
  TrainConfig config = timed_training();
  config.train.cache_mb = 0;
  config.optimizer.accumulate = 2;
  std::vector<DepthSample> samples;
  for (int i = 0; i < 4; ++i) samples.push_back(test::scene_sample(i));
  CountingSource training(samples);
  benchmark_training(config, training, 1);
  const int steps_with_warm_up = 3;
  EXPECT_EQ(training.reads, steps_with_warm_up * 2 * 2);
  EXPECT_THROW(benchmark_training(config, training, 0), std::invalid_argument);
}

}  // namespace
}  // namespace alight
