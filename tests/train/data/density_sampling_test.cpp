#include "train/data/density_sampling.hpp"

#include <set>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace {

torch::Generator generator(std::uint64_t seed = 1) { return at::detail::createCPUGenerator(seed); }
DrawKey at_step(std::int64_t step, std::uint64_t seed = 1) { return {seed, step, 0}; }
torch::Tensor images(std::int64_t batch) { return torch::ones({batch, 3, 40, 50}); }
torch::Tensor points(std::int64_t batch) { return torch::full({batch, 1, 40, 50}, 12.0F); }
torch::Tensor no_offset(std::int64_t batch) { return torch::zeros({batch, 1, 40, 50}); }

/// Share of the points of each sample that was fed.
torch::Tensor fed_share(const torch::Tensor& sparse_m) {
  return (sparse_m > 0).to(torch::kFloat64).mean({1, 2, 3});
}

TEST(DensitySampling, KeepShareKeepsTheShare) {
  torch::Generator random = generator();
  const torch::Tensor all = points(4);
  EXPECT_TRUE(torch::equal(keep_share(all, torch::tensor(1.0), random), all));
  EXPECT_EQ(keep_share(all, torch::tensor(0.0), random).sum().item<double>(), 0);
  const torch::Tensor kept = keep_share(all, torch::tensor(0.3), random);
  EXPECT_NEAR(fed_share(kept).mean().item<double>(), 0.3, 0.02);
  EXPECT_TRUE(torch::equal(kept * (kept > 0), all * (kept > 0)));
}

TEST(DensitySampling, KeepWindowIsHalfOpen) {
  const torch::Tensor sparse = torch::ones({1, 1, 1, 4});
  const torch::Tensor offset = torch::tensor({-0.1F, 0.0F, 0.25F, 0.5F}).view({1, 1, 1, 4});
  const torch::Tensor kept = keep_window(sparse, offset, 0, torch::full({1, 1, 1, 1}, 0.5));
  EXPECT_TRUE(torch::equal(kept.view(-1), torch::tensor({0.0F, 1.0F, 1.0F, 0.0F})));
}

TEST(DensitySampling, PaperModeDrawsOneDensityABatch) {
  int without = 0;
  constexpr int kBatches = 400;
  for (int i = 0; i < kBatches; ++i) {
    const torch::Tensor share =
        fed_share(sample_density(images(2), images(2), points(2), no_offset(2), {}, at_step(i)).sparse_m);
    const double first = share[0].item<double>();
    if (first == 0) {
      ++without;
      EXPECT_EQ(share[1].item<double>(), 0);
    } else {
      EXPECT_GT(first, 0.07);
      EXPECT_LT(first, 0.54);
      EXPECT_NEAR(share[1].item<double>(), first, 0.06);  // the same density, other points
    }
  }
  EXPECT_NEAR(without / static_cast<double>(kBatches), 0.2, 0.06);
}

TEST(DensitySampling, DrawBySampleMixesABatch) {
  DensitySamplingConfig config;
  config.draw = DensityDraw::kSample;
  const torch::Tensor share = fed_share(
      sample_density(images(64), images(64), points(64), no_offset(64), config, at_step(0)).sparse_m);
  EXPECT_GT((share == 0).sum().item<int>(), 3);
  EXPECT_GT((share > 0.3).sum().item<int>(), 10);
  EXPECT_GT(((share > 0) & (share < 0.3)).sum().item<int>(), 10);
}

TEST(DensitySampling, WindowFeedsTheFirstPointsInTime) {
  DensitySamplingConfig config;
  config.mode = DensityMode::kWindow;
  config.no_lidar_probability = 0;
  config.window_min_s = 0.2;
  config.window_max_s = 0.6;
  const torch::Tensor offset = torch::linspace(-1, 1, 2000).view({1, 1, 40, 50});
  std::set<double> latest;
  for (int i = 0; i < 20; ++i) {
    const torch::Tensor fed =
        sample_density(images(1), images(1), points(1), offset, config, at_step(i)).sparse_m > 0;
    const torch::Tensor times = offset.masked_select(fed);
    EXPECT_GE(times.min().item<double>(), 0);
    EXPECT_LT(times.min().item<double>(), 0.01);
    EXPECT_GT(times.max().item<double>(), 0.19);
    EXPECT_LT(times.max().item<double>(), 0.6);
    EXPECT_EQ(times.numel(), ((offset >= 0) & (offset <= times.max())).sum().item<std::int64_t>());
    latest.insert(times.max().item<double>());
  }
  EXPECT_GT(latest.size(), 10U);
}

TEST(DensitySampling, NeverWithoutBothSensors) {
  DensitySamplingConfig config;
  config.no_lidar_probability = 0.5;
  config.no_image_probability = 0.5;
  int without_image = 0;
  for (int i = 0; i < 200; ++i) {
    const NetworkInput input =
        sample_density(images(1), images(1), points(1), no_offset(1), config, at_step(i));
    const bool image = input.image.sum().item<double>() > 0;
    EXPECT_TRUE(image || input.sparse_m.sum().item<double>() > 0);
    without_image += !image;
  }
  EXPECT_NEAR(without_image / 200.0, 0.25, 0.1);
}

TEST(DensitySampling, MixedFeedsSharesAndWindows) {
  DensitySamplingConfig config;
  config.mode = DensityMode::kMixed;
  config.no_lidar_probability = 0;
  config.window_begin_min_s = config.window_begin_max_s = -0.3;
  const torch::Tensor offset = torch::linspace(-1, 1, 2000).view({1, 1, 40, 50});
  int windows = 0;
  for (int i = 0; i < 100; ++i) {
    const torch::Tensor fed =
        sample_density(images(1), images(1), points(1), offset, config, at_step(i)).sparse_m > 0;
    windows += offset.masked_select(fed).min().item<double>() >= -0.3 ? 1 : 0;
  }
  EXPECT_NEAR(windows / 100.0, 0.5, 0.15);
}

TEST(DensitySampling, RightCameraAndHeightAreDroppedAsOftenAsSaid) {
  DensitySamplingConfig config;
  config.draw = DensityDraw::kSample;
  config.no_right_probability = 0.3;
  config.no_height_probability = 0.2;
  const NetworkInput input =
      sample_density(images(400), images(400), points(400), no_offset(400), config, at_step(0));
  EXPECT_NEAR((input.right.amax({1, 2, 3}) == 0).to(torch::kFloat32).mean().item<double>(), 0.3, 0.07);
  EXPECT_NEAR(input.knows_height.to(torch::kFloat32).mean().item<double>(), 0.8, 0.07);
  EXPECT_EQ((input.image.amax({1, 2, 3}) == 0).sum().item<int>(), 0);
}

TEST(DensitySampling, SameKeySamePoints) {
  const auto draw = [](const DrawKey& key) {
    return sample_density(images(2), images(2), points(2), no_offset(2), {}, key).sparse_m;
  };
  EXPECT_TRUE(torch::equal(draw(at_step(5, 3)), draw(at_step(5, 3))));
  EXPECT_FALSE(torch::equal(draw(at_step(5, 3)), draw(at_step(6, 3))));
  EXPECT_FALSE(torch::equal(draw(at_step(5, 3)), draw(at_step(5, 4))));
}

TEST(DensitySampling, PartsOfABatchDrawWhatTheWholeDraws) {
  for (const DensityDraw mode : {DensityDraw::kBatch, DensityDraw::kSample}) {
    DensitySamplingConfig config;
    config.draw = mode;
    const auto draw = [&](std::int64_t count, std::int64_t first) {
      return sample_density(images(count), images(count), points(count), no_offset(count), config,
                            {3, 7, first})
          .sparse_m;
    };
    EXPECT_TRUE(torch::equal(draw(4, 0), torch::cat({draw(2, 0), draw(2, 2)})));
  }
}

TEST(DensitySamplingConfig, RefusesEmptyRanges) {
  EXPECT_THROW(parse_config<DensitySamplingConfig>("{min_share: 0.5, max_share: 0.4}", "test"), ConfigError);
  EXPECT_THROW(parse_config<DensitySamplingConfig>("{window_min_s: 2, window_max_s: 1}", "test"),
               ConfigError);
}

}  // namespace
}  // namespace alight
