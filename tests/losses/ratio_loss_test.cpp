#include "losses/ratio_loss.hpp"

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

using test::map64;

TEST(RatioLoss, ByHand) {
  // |2 - 2| / 2, |3 - 1| / 1, |4 - 5| / 5; the first pixel is missing.
  EXPECT_NEAR(ratio_loss(map64({1, 2, 3, 4}, 2), map64({0, 2, 1, 5}, 2)).item<double>(), (0 + 2 + 0.2) / 3,
              1e-12);
}

TEST(RatioLoss, TheSameErrorCountsMoreNearTheGround) {
  const double high = ratio_loss(map64({31}, 1), map64({30}, 1)).item<double>();
  const double low = ratio_loss(map64({4}, 1), map64({3}, 1)).item<double>();
  EXPECT_NEAR(low / high, 10, 1e-9);
}

TEST(RatioLoss, GradientIsThatOfCentralDifferences) {
  torch::manual_seed(1);
  const torch::Tensor prediction = 2 + torch::rand({2, 1, 3, 5}, torch::kFloat64);
  const torch::Tensor target =
      (2 + torch::rand_like(prediction)) * (torch::rand_like(prediction) < 0.5).to(torch::kFloat64);
  EXPECT_LT(test::gradient_error([&](const torch::Tensor& p) { return ratio_loss(p, target); }, prediction),
            1e-6);
}

TEST(RatioLoss, NoTargetIsZeroWithZeroGradient) {
  const torch::Tensor prediction = torch::full({1, 1, 3, 5}, 2.0, torch::kFloat64);
  const auto loss = [](const torch::Tensor& p) { return ratio_loss(p, torch::zeros_like(p)); };
  EXPECT_EQ(loss(prediction).item<double>(), 0);
  EXPECT_TRUE(torch::equal(test::autograd_gradient(loss, prediction), torch::zeros_like(prediction)));
}

TEST(RatioLoss, ChangesNeitherWithSizeNorWithDensity) {
  const torch::Tensor prediction = torch::full({1, 1, 5, 5}, 3.0, torch::kFloat64);
  torch::Tensor target = torch::full({1, 1, 5, 5}, 2.0, torch::kFloat64);
  target.view(-1).slice(0, 0, 20).zero_();
  EXPECT_NEAR(ratio_loss(prediction, target).item<double>(), 0.5, 1e-12);
  EXPECT_NEAR(ratio_loss(prediction.repeat({1, 1, 3, 2}), target.repeat({1, 1, 3, 2})).item<double>(), 0.5,
              1e-12);
}

}  // namespace
}  // namespace alight
