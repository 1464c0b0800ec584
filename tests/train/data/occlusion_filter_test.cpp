#include "train/data/occlusion_filter.hpp"

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace {

/// Ground at 20 m with one point of a roof at 15 m in the middle.
torch::Tensor ground_with_roof() {
  torch::Tensor sparse_m = torch::full({1, 1, 9, 9}, 20.0);
  sparse_m[0][0][4][4] = 15;
  return sparse_m;
}

TEST(OcclusionFilter, DropsOldPointsBehindANearerNeighbour) {
  const torch::Tensor sparse_m = ground_with_roof();
  const torch::Tensor old = torch::full_like(sparse_m, -1.0);
  const torch::Tensor kept = drop_hidden_points(sparse_m, old, {5, 0.25, 0.03});
  EXPECT_EQ(kept[0][0][4][4].item<float>(), 15);
  EXPECT_EQ(kept[0][0][4][6].item<float>(), 0);
  EXPECT_EQ(kept[0][0][4][7].item<float>(), 20);
  EXPECT_EQ((kept == 0).sum().item<int>(), 24);
}

TEST(OcclusionFilter, FreshPointsAndSmallStepsStay) {
  const torch::Tensor sparse_m = ground_with_roof();
  const torch::Tensor fresh = torch::full_like(sparse_m, 0.2);
  EXPECT_TRUE(torch::equal(drop_hidden_points(sparse_m, fresh, {5, 0.25, 0.03}), sparse_m));
  const torch::Tensor old = torch::full_like(sparse_m, 1.0);
  EXPECT_TRUE(torch::equal(drop_hidden_points(sparse_m, old, {5, 0.25, 0.3}), sparse_m));
  EXPECT_TRUE(torch::equal(drop_hidden_points(sparse_m, old, {}), sparse_m)) << "off by default";
}

TEST(OcclusionFilter, MissingPointsHideNothing) {
  torch::Tensor sparse_m = torch::zeros({1, 1, 9, 9});
  sparse_m[0][0][2][2] = 20;
  const torch::Tensor old = torch::full_like(sparse_m, 1.0);
  EXPECT_TRUE(torch::equal(drop_hidden_points(sparse_m, old, {5, 0.25, 0.03}), sparse_m));
}

TEST(OcclusionFilterConfig, WindowIsOdd) {
  EXPECT_THROW(parse_config<OcclusionFilterConfig>("window_px: 4", "test"), ConfigError);
}

}  // namespace
}  // namespace alight
