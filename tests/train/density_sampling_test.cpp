#include "train/density_sampling.hpp"

#include <set>

#include <gtest/gtest.h>

#include "configs/errors.hpp"

namespace alight {
namespace {

torch::Generator generator(std::uint64_t seed = 1) { return at::detail::createCPUGenerator(seed); }
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
  torch::Generator random = generator();
  int without = 0;
  constexpr int kBatches = 400;
  for (int i = 0; i < kBatches; ++i) {
    const torch::Tensor share =
        fed_share(sample_density(images(2), points(2), no_offset(2), {}, random).sparse_m);
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
  torch::Generator random = generator();
  const torch::Tensor share =
      fed_share(sample_density(images(64), points(64), no_offset(64), config, random).sparse_m);
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
  torch::Generator random = generator();
  std::set<double> latest;
  for (int i = 0; i < 20; ++i) {
    const torch::Tensor fed = sample_density(images(1), points(1), offset, config, random).sparse_m > 0;
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
  torch::Generator random = generator();
  int without_image = 0;
  for (int i = 0; i < 200; ++i) {
    const NetworkInput input = sample_density(images(1), points(1), no_offset(1), config, random);
    const bool image = input.image.sum().item<double>() > 0;
    EXPECT_TRUE(image || input.sparse_m.sum().item<double>() > 0);
    without_image += !image;
  }
  EXPECT_NEAR(without_image / 200.0, 0.25, 0.1);
}

TEST(DensitySampling, SameSeedSamePoints) {
  torch::Generator a = generator(3);
  torch::Generator b = generator(3);
  torch::Generator c = generator(4);
  const auto draw = [](torch::Generator& random) {
    return sample_density(images(2), points(2), no_offset(2), {}, random).sparse_m +
           sample_density(images(2), points(2), no_offset(2), {}, random).sparse_m;
  };
  const torch::Tensor first = draw(a);
  EXPECT_TRUE(torch::equal(first, draw(b)));
  EXPECT_FALSE(torch::equal(first, draw(c)));
}

TEST(DensitySamplingConfig, RefusesEmptyRanges) {
  EXPECT_THROW(parse_config<DensitySamplingConfig>("{min_share: 0.5, max_share: 0.4}", "test"), ConfigError);
  EXPECT_THROW(parse_config<DensitySamplingConfig>("{window_min_s: 2}", "test"), ConfigError);
}

}  // namespace
}  // namespace alight
