#include "losses/ssim.hpp"

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

constexpr double kC1 = 1e-4;
constexpr double kC2 = 9e-4;

TEST(Ssim, EqualImagesAreOne) {
  const torch::Tensor image = torch::rand({2, 3, 7, 9}, torch::kFloat64);
  EXPECT_TRUE(torch::allclose(ssim_map(image, image), torch::ones_like(image), 0, 1e-12));
}

TEST(Ssim, ConstantImagesCompareByBrightnessAlone) {
  const torch::Tensor a = torch::full({1, 1, 5, 5}, 0.2, torch::kFloat64);
  const torch::Tensor b = torch::full({1, 1, 5, 5}, 0.6, torch::kFloat64);
  const double expected = (2 * 0.2 * 0.6 + kC1) / (0.04 + 0.36 + kC1);
  EXPECT_TRUE(torch::allclose(ssim_map(a, b), torch::full_like(a, expected), 0, 1e-9));
}

TEST(Ssim, CentreWindowByHand) {
  // x: nine values of mean 0.2 (one 1.8 above zero each third), y: the same turned over.
  const torch::Tensor x = test::map64({0.6, 0, 0, 0.6, 0, 0, 0.6, 0, 0}, 3);
  const torch::Tensor y = test::map64({0, 0, 0.6, 0, 0, 0.6, 0, 0, 0.6}, 3);
  const double variance = 0.12 - 0.04;  // E[x^2] - E[x]^2
  const double covariance = 0 - 0.04;
  const double expected = (2 * 0.04 + kC1) * (2 * covariance + kC2) / ((0.08 + kC1) * (2 * variance + kC2));
  EXPECT_NEAR((ssim_map(x, y)[0][0][1][1].item<double>()), expected, 1e-9);
}

TEST(Ssim, CornerWindowIsReflected) {
  // Reflection about the border pixel: the corner's window is e d e / b a b / e d e of a b / d e.
  const torch::Tensor x = test::map64({0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}, 3);
  const torch::Tensor window = test::map64({0.5, 0.4, 0.5, 0.2, 0.1, 0.2, 0.5, 0.4, 0.5}, 3);
  const torch::Tensor y = torch::full_like(x, 0.5);
  const double corner = ssim_map(x, y)[0][0][0][0].item<double>();
  EXPECT_NEAR(corner, (ssim_map(window, y)[0][0][1][1].item<double>()), 1e-12);
}

TEST(Ssim, GradientIsThatOfCentralDifferences) {
  torch::manual_seed(1);
  const torch::Tensor a = torch::rand({1, 2, 5, 3}, torch::kFloat64);
  const torch::Tensor b = torch::rand_like(a);
  const torch::Tensor weight = torch::rand_like(a);
  EXPECT_LT(test::gradient_error([&](const torch::Tensor& x) { return (weight * ssim_map(x, b)).sum(); }, a),
            1e-6);
}

TEST(Ssim, RefusesImagesWithoutANeighbour) {
  EXPECT_THROW(ssim_map(torch::rand({1, 1, 1, 5}), torch::rand({1, 1, 1, 5})), std::invalid_argument);
}

}  // namespace
}  // namespace alight
