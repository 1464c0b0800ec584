#include "losses/smoothness_loss.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

/// a u + b v + c u^2 on a grid. @returns [1,1,rows,columns]
torch::Tensor surface(double a, double b, double c, std::int64_t rows, std::int64_t columns) {
  const torch::Tensor u = torch::arange(columns, torch::kFloat64).view({1, 1, 1, -1});
  const torch::Tensor v = torch::arange(rows, torch::kFloat64).view({1, 1, -1, 1});
  return 10 + a * u + b * v + c * u * u;
}

TEST(SmoothnessLoss, SlopeCountsByItsFirstDerivatives) {
  EXPECT_NEAR(smoothness_loss(surface(2, -3, 0, 5, 7), {}).item<double>(), 5, 1e-12);
}

TEST(SmoothnessLoss, LevelGroundIsFree) {
  EXPECT_EQ(smoothness_loss(torch::full({2, 1, 5, 7}, 12.0), {}).item<double>(), 0);
}

TEST(SmoothnessLoss, CurvatureCountsByBothDerivatives) {
  // u^2 at u = 0..4: first differences 1 3 5 7 (mean 4), second 2.
  EXPECT_NEAR(smoothness_loss(surface(0, 0, 1, 3, 5), {}).item<double>(), 4 + 2, 1e-12);
}

TEST(SmoothnessLoss, TwistCountsTwice) {
  // u v on 2x2: dx is 0 and 1, dy is 0 and 1, dxy is 1.
  EXPECT_NEAR(smoothness_loss(test::map64({0, 0, 0, 1}, 2), {}).item<double>(), 0.5 + 0.5 + 2, 1e-12);
}

TEST(SmoothnessLoss, RelativeIsTheSameAtAllAltitudes) {
  SmoothnessLossConfig config;
  config.relative = true;
  const torch::Tensor depth = surface(0.1, 0.2, 0.05, 5, 5);
  EXPECT_NEAR(smoothness_loss(depth, {}, config).item<double>(),
              smoothness_loss(depth * 7, {}, config).item<double>(), 1e-12);
}

TEST(SmoothnessLoss, EdgeAwareSparesImageEdges) {
  SmoothnessLossConfig config;
  config.edge_aware = true;
  config.edge_sharpness = 2;
  const torch::Tensor depth = test::map64({0, 4, 0, 4}, 2);  // one step in every row
  const torch::Tensor flat = torch::zeros({1, 3, 2, 2}, torch::kFloat64);
  const torch::Tensor edge = test::map64({0, 0.5, 0, 0.5}, 2).expand({1, 3, 2, 2});
  EXPECT_NEAR(smoothness_loss(depth, flat, config).item<double>(), 4, 1e-12);
  EXPECT_NEAR(smoothness_loss(depth, edge, config).item<double>(), 4 * std::exp(-1.0), 1e-12);
  EXPECT_THROW(smoothness_loss(depth, torch::zeros({1, 3, 2, 3}), config), std::invalid_argument);
}

TEST(SmoothnessLoss, GradientIsThatOfCentralDifferences) {
  torch::manual_seed(1);
  const torch::Tensor depth = 5 + torch::rand({2, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor image = torch::rand({2, 3, 5, 7}, torch::kFloat64);
  for (const bool option : {false, true}) {
    SmoothnessLossConfig config;
    config.edge_aware = option;
    config.relative = option;
    const auto loss = [&](const torch::Tensor& d) { return smoothness_loss(d, image, config); };
    EXPECT_LT(test::gradient_error(loss, depth), 1e-5);
  }
}

TEST(SmoothnessLoss, MapsWithoutNeighboursAreZero) {
  const auto loss = [](const torch::Tensor& d) { return smoothness_loss(d, {}); };
  const torch::Tensor one = torch::full({1, 1, 1, 1}, 3.0, torch::kFloat64);
  EXPECT_EQ(loss(one).item<double>(), 0);
  EXPECT_EQ(test::autograd_gradient(loss, one).item<double>(), 0);
  EXPECT_NEAR(loss(test::map64({1, 3}, 1)).item<double>(), 2, 1e-12);
}

}  // namespace
}  // namespace alight
