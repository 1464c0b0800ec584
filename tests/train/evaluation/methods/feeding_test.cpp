#include "train/evaluation/methods/feeding.hpp"

#include <gtest/gtest.h>

#include "tests/train/data/memory_source.hpp"

namespace alight {
namespace {

Feeding share(double amount) { return {Feeding::Kind::kShare, amount}; }
Feeding window(double amount) { return {Feeding::Kind::kWindow, amount}; }

std::int64_t points(const torch::Tensor& map) { return (map > 0).sum().item<std::int64_t>(); }

TEST(Feeding, NamesSayKindAndAmount) {
  EXPECT_EQ(share(0).name(), "P=0");
  EXPECT_EQ(share(0.3).name(), "P=0.3");
  EXPECT_EQ(window(1.4).name(), "1.4 s");
  EXPECT_EQ(make_feedings({0.5}, {0.1})[1].name(), "0.1 s");
}

TEST(Feeding, SharesAreNestedAndRepeatable) {
  const DepthSample sample = test::scene_sample(0);
  EXPECT_EQ(points(feed(sample, share(0), 1)), 0);
  EXPECT_TRUE(torch::equal(feed(sample, share(1), 1), sample.sparse));
  const torch::Tensor less = feed(sample, share(0.2), 1);
  const torch::Tensor more = feed(sample, share(0.6), 1);
  EXPECT_NEAR(static_cast<double>(points(more)), 0.6 * static_cast<double>(points(sample.sparse)), 60);
  EXPECT_TRUE(torch::equal(less * (more > 0), less));
  EXPECT_TRUE(torch::equal(less, feed(sample, share(0.2), 1)));
  EXPECT_FALSE(torch::equal(less, feed(sample, share(0.2), 2)));
}

TEST(Feeding, AWindowBeginsWithTheImage) {
  DepthSample sample;
  sample.sparse = torch::tensor({5.0F, 6.0F, 7.0F, 8.0F}).view({1, 1, 4});
  sample.offset_s = torch::tensor({-0.1F, 0.0F, 0.25F, 0.3F}).view({1, 1, 4});
  EXPECT_TRUE(torch::equal(feed(sample, window(0.3), 1).flatten(), torch::tensor({0.0F, 6.0F, 7.0F, 0.0F})));
}

}  // namespace
}  // namespace alight
