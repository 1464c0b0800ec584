#include "losses/depth_loss.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

using test::autograd_gradient;
using test::gradient_error;
using test::map64;

TEST(DepthLoss, SquaredByHand) {
  const torch::Tensor loss = depth_loss(map64({1, 2, 3, 4}, 2), map64({0, 2, 1, 0}, 2));
  EXPECT_DOUBLE_EQ(loss.item<double>(), (0.0 + 4.0) / 2);
}

TEST(DepthLoss, LogByHand) {
  const torch::Tensor loss = depth_loss(map64({1, 2, 3, 4}, 2), map64({0, 4, 1, 0}, 2), DepthError::kLog);
  EXPECT_NEAR(loss.item<double>(), (std::log(2.0) + std::log(3.0)) / 2, 1e-12);
}

TEST(DepthLoss, RmseByHandIsAMeanOfTheSamplesRoots) {
  const torch::Tensor prediction = torch::cat({map64({1, 2, 3, 4}, 2), map64({5, 5, 5, 5}, 2)});
  const torch::Tensor target = torch::cat({map64({0, 2, 1, 0}, 2), map64({9, 0, 0, 0}, 2)});
  EXPECT_NEAR(depth_loss(prediction, target, DepthError::kRmse).item<double>(), (std::sqrt(2.0) + 4.0) / 2,
              2e-3);
}

class DepthLossForms : public testing::TestWithParam<DepthError> {};

TEST_P(DepthLossForms, GradientIsThatOfCentralDifferences) {
  torch::manual_seed(1);
  const torch::Tensor prediction = 2 + torch::rand({2, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor target =
      (2 + torch::rand_like(prediction)) * (torch::rand_like(prediction) < 0.5).to(torch::kFloat64);
  EXPECT_LT(
      gradient_error([&](const torch::Tensor& p) { return depth_loss(p, target, GetParam()); }, prediction),
      1e-6);
}

TEST_P(DepthLossForms, NoTargetIsZeroWithZeroGradient) {
  const torch::Tensor prediction = torch::full({1, 1, 3, 5}, 2.0, torch::kFloat64);
  const auto loss = [&](const torch::Tensor& p) { return depth_loss(p, torch::zeros_like(p), GetParam()); };
  EXPECT_EQ(loss(prediction).item<double>(), 0);
  EXPECT_TRUE(torch::equal(autograd_gradient(loss, prediction), torch::zeros_like(prediction)));
}

TEST_P(DepthLossForms, ChangesNeitherWithSizeNorWithDensity) {
  const torch::Tensor prediction = torch::full({1, 1, 5, 5}, 3.0, torch::kFloat64);
  const torch::Tensor target = torch::full({1, 1, 5, 5}, 2.0, torch::kFloat64);
  torch::Tensor sparse = target.clone();
  sparse.view(-1).slice(0, 0, 20).zero_();
  const double dense_loss = depth_loss(prediction, target, GetParam()).item<double>();
  EXPECT_NEAR(depth_loss(prediction, sparse, GetParam()).item<double>(), dense_loss, 1e-12);
  EXPECT_NEAR(
      depth_loss(prediction.repeat({1, 1, 2, 3}), target.repeat({1, 1, 2, 3}), GetParam()).item<double>(),
      dense_loss, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, DepthLossForms,
                         testing::Values(DepthError::kSquared, DepthError::kLog, DepthError::kRmse));

TEST(DepthLoss, RefusesOtherShapes) {
  EXPECT_THROW(depth_loss(torch::ones({1, 1, 2, 2}), torch::ones({1, 1, 2, 3})), std::invalid_argument);
  EXPECT_THROW(depth_loss(torch::ones({2, 2}), torch::ones({2, 2})), std::invalid_argument);
}

}  // namespace
}  // namespace alight
