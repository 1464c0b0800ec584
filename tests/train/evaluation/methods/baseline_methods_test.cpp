#include "train/evaluation/methods/baseline_methods.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/train/evaluation/evaluation_scenes.hpp"

namespace alight {
namespace {

TEST(BaselineMethods, LevelGroundIsExactFromAFewPoints) {
  DepthSample sample = test::scene_sample(0);
  sample.height_m = 12;
  torch::Tensor fed_m = torch::zeros({1, 48, 48});
  for (const auto& [row, column] : {std::pair{5, 5}, {40, 8}, {22, 44}, {30, 20}}) fed_m[0][row][column] = 12;
  for (const auto& method : make_baselines({})) {
    const torch::Tensor depth_m = method->complete(sample, fed_m);
    ASSERT_EQ(depth_m.sizes(), fed_m.sizes()) << method->name();
    EXPECT_LT((depth_m - 12).abs().max().item<float>(), 1e-4F) << method->name();
  }
}

TEST(BaselineMethods, WithoutPointsOnlyTheAltitudePlaneKnowsAnything) {
  DepthSample sample = test::scene_sample(0);
  sample.height_m = 12;
  for (const auto& method : make_baselines({})) {
    const torch::Tensor depth_m = method->complete(sample, torch::zeros({1, 48, 48}));
    const bool knows = (depth_m > 0).any().item<bool>();
    EXPECT_EQ(knows, method->name() == "altitude plane") << method->name();
  }
}

TEST(BaselineMethods, AltitudePlaneOfUnknownHeightIsUnknown) {
  DepthSample sample = test::scene_sample(0);
  for (const double height_m : {std::nan(""), 0.0, -3.0}) {
    sample.height_m = height_m;
    const torch::Tensor depth_m = make_altitude_plane({})->complete(sample, sample.sparse);
    EXPECT_FALSE((depth_m != 0).any().item<bool>()) << height_m;
  }
}

}  // namespace
}  // namespace alight
