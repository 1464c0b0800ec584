#include "train/validation.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/models/tiny_net.hpp"
#include "tests/train/data/memory_source.hpp"

namespace alight {
namespace {

using test::MemorySource;
using test::scenes;

ValidationConfig shares(std::vector<double> values) {
  ValidationConfig config;
  config.shares = std::move(values);
  return config;
}

TEST(Spread, TakesEvenlySpreadSamples) {
  EXPECT_EQ(spread(10, 5), (std::vector<std::size_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(spread(3, 0), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(spread(3, 9), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Validation, RowsAreThoseOfTheNetworksOwnOutput) {
  MemorySource source = scenes(2);
  torch::manual_seed(1);
  DepthCompletionNet net(test::tiny_config());
  const ValidationReport report = validate(net, source, {0, 1}, shares({0, 1}), 9);
  net->eval();
  torch::NoGradGuard no_grad;
  ErrorMeter without_lidar;
  ErrorMeter dense;
  for (std::size_t i = 0; i < 2; ++i) {
    const DepthSample s = source.get(i);
    const torch::Tensor sparse = s.sparse.unsqueeze(0);
    without_lidar.add(net->forward({s.left.unsqueeze(0)}, sparse * 0), sparse, sparse > 0);
    dense.add(net->forward({s.left.unsqueeze(0)}, sparse), s.dense.unsqueeze(0), s.dense.unsqueeze(0) > 0);
  }
  EXPECT_DOUBLE_EQ(report.network[0].ground_truth.rmse_mm(), without_lidar.rmse_mm());
  EXPECT_DOUBLE_EQ(report.network[0].held_out.rmse_mm(), without_lidar.rmse_mm());  // nothing was fed
  EXPECT_DOUBLE_EQ(report.network[1].dense.rmse_mm(), dense.rmse_mm());
  EXPECT_EQ(report.network[1].held_out.pixels(), 0);  // all was fed
  EXPECT_NEAR(report.score_mm(),
              std::sqrt(report.network[0].ground_truth.rmse_mm() * report.network[1].ground_truth.rmse_mm()),
              1e-6);
}

TEST(Validation, HeldOutPixelsAreThoseNotFed) {
  MemorySource source = scenes(3);
  DepthCompletionNet net(test::tiny_config());
  const ValidationReport report = validate(net, source, {0, 1, 2}, shares({0.3}), 9);
  const double share = static_cast<double>(report.network[0].held_out.pixels()) /
                       static_cast<double>(report.network[0].ground_truth.pixels());
  EXPECT_NEAR(share, 0.7, 0.06);
}

TEST(Validation, FillIsExactWhereAllIsFedAndAbsentWithoutPoints) {
  MemorySource source = scenes(2);
  DepthCompletionNet net(test::tiny_config());
  const ValidationReport report = validate(net, source, {0, 1}, shares({0, 0.3, 1}), 9);
  EXPECT_EQ(report.fill_at(0).ground_truth.pixels(), 0);
  EXPECT_GT(report.fill_at(0.3).held_out.rmse_mm(), 1);
  EXPECT_LT(report.fill_at(1).ground_truth.rmse_mm(), 0.1);
}

TEST(Validation, AltitudePlaneIsWrongByTheTakeOffHeight) {
  // The scenes' height is a metre more than the depth of their ground; points on the block are 4 m off.
  DepthSample sample = test::scene_sample(3);
  sample.dense.fill_(9);
  sample.sparse = sample.dense * (sample.sparse > 0);
  sample.height_m = 10;
  MemorySource source({sample});
  DepthCompletionNet net(test::tiny_config());
  const ValidationReport report = validate(net, source, {0}, shares({0}), 9);
  EXPECT_NEAR(report.altitude_plane.ground_truth.rmse_mm(), 1000, 1e-3);
  EXPECT_NEAR(report.altitude_plane.dense.rmse_mm(), 1000, 1e-3);
}

TEST(Validation, UnknownHeightLeavesThePlaneOut) {
  DepthSample sample = test::scene_sample(3);
  sample.height_m = std::nan("");
  MemorySource source({sample});
  DepthCompletionNet net(test::tiny_config());
  const ValidationReport report = validate(net, source, {0}, shares({0.3}), 9);
  EXPECT_EQ(report.altitude_plane.ground_truth.pixels(), 0);
  EXPECT_THAT(report.table(), testing::HasSubstr("P=0.3"));
}

TEST(Validation, SameSeedSameNumbersAndTheModeIsKept) {
  MemorySource source = scenes(2);
  DepthCompletionNet net(test::tiny_config());
  net->train();
  const auto rmse = [&](std::uint64_t seed) {
    return validate(net, source, {0, 1}, shares({0.3}), seed).network[0].ground_truth.rmse_mm();
  };
  EXPECT_EQ(rmse(1), rmse(1));
  EXPECT_NE(rmse(1), rmse(2));
  EXPECT_TRUE(net->is_training());
}

TEST(Validation, WindowsFeedThePointsAfterTheImage) {
  DepthCompletionNet net(test::tiny_config());
  MemorySource source = test::scenes(1);
  ValidationConfig config = shares({1});
  config.windows_s = {0.25};
  const ValidationReport report = validate(net, source, {0}, config, 9);
  ASSERT_EQ(report.network.size(), 2U);
  EXPECT_EQ(report.network[1].name, "0.25s");
  EXPECT_EQ(report.network[0].held_out.pixels(), 0);
  const double fed = 1 - static_cast<double>(report.network[1].held_out.pixels()) /
                             static_cast<double>(report.network[1].ground_truth.pixels());
  EXPECT_NEAR(fed, 0.25, 0.05);  // offsets are uniform in 0..1 s
  EXPECT_EQ(report.at(1).name, "P=1");
}

}  // namespace
}  // namespace alight
