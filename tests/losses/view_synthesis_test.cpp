#include "losses/view_synthesis.hpp"

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

torch::Tensor view_intrinsics(std::int64_t batch = 1) {
  return torch::tensor({{10.0, 10.0, 3.0, 2.0}}, torch::kFloat64).repeat({batch, 1});
}

torch::Tensor translation(double x, double y, double z) {
  torch::Tensor T = torch::eye(4, torch::kFloat64);
  T[0][3] = x;
  T[1][3] = y;
  T[2][3] = z;
  return T.unsqueeze(0);
}

TEST(ViewSynthesis, IdentityGivesTheImageBack) {
  const torch::Tensor image = torch::rand({1, 3, 5, 7}, torch::kFloat64);
  const torch::Tensor depth = 4 + torch::rand({1, 1, 5, 7}, torch::kFloat64);
  const SynthesisedView view = synthesise_view(image, depth, view_intrinsics(), translation(0, 0, 0));
  EXPECT_TRUE(torch::allclose(view.image, image, 0, 1e-9));
  EXPECT_TRUE(view.valid.all().item<bool>());
}

TEST(ViewSynthesis, StereoShiftIsFocalLengthTimesBaselineOverDepth) {
  // f 10 px, baseline 0.8 m, depth 4 m: disparity 2 px. The target's pixel u is the right image's u - 2.
  const torch::Tensor right = torch::rand({1, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor depth = torch::full({1, 1, 5, 7}, 4.0, torch::kFloat64);
  const SynthesisedView view = synthesise_view(right, depth, view_intrinsics(), translation(-0.8, 0, 0));
  EXPECT_TRUE(torch::allclose(view.image.slice(3, 2), right.slice(3, 0, 5), 0, 1e-9));
  EXPECT_FALSE(view.valid.slice(3, 0, 2).any().item<bool>());
  EXPECT_TRUE(view.valid.slice(3, 2).all().item<bool>());
}

TEST(ViewSynthesis, HalfAPixelIsTheMeanOfTwo) {
  const torch::Tensor source = torch::rand({1, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor depth = torch::full({1, 1, 5, 7}, 4.0, torch::kFloat64);
  const SynthesisedView view = synthesise_view(source, depth, view_intrinsics(), translation(0, 0.2, 0));
  const torch::Tensor expected = (source.slice(2, 0, 4) + source.slice(2, 1, 5)) / 2;
  EXPECT_TRUE(torch::allclose(view.image.slice(2, 0, 4), expected, 0, 1e-9));
}

TEST(ViewSynthesis, BehindTheSourceIsNotValid) {
  const torch::Tensor image = torch::rand({1, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor depth = torch::full({1, 1, 5, 7}, 4.0, torch::kFloat64);
  const SynthesisedView view = synthesise_view(image, depth, view_intrinsics(), translation(0, 0, -5));
  EXPECT_FALSE(view.valid.any().item<bool>());
  EXPECT_TRUE(view.image.isfinite().all().item<bool>());
}

TEST(ViewSynthesis, GradientOfDepthIsThatOfCentralDifferences) {
  torch::manual_seed(1);
  const torch::Tensor image = torch::rand({2, 2, 5, 7}, torch::kFloat64);
  const torch::Tensor depth = 4 + torch::rand({2, 1, 5, 7}, torch::kFloat64);
  const torch::Tensor T = torch::cat({translation(-0.23, 0.11, 0.3), translation(0.17, 0.31, -0.2)});
  const auto loss = [&](const torch::Tensor& d) {
    const SynthesisedView view = synthesise_view(image, d, view_intrinsics(2), T);
    return (view.image.square() * view.valid).sum();
  };
  EXPECT_LT(test::gradient_error(loss, depth), 1e-6);
}

TEST(ViewSynthesis, RefusesWrongShapes) {
  const torch::Tensor image = torch::rand({1, 3, 5, 7});
  const torch::Tensor depth = torch::ones({1, 1, 5, 7});
  const torch::Tensor K = torch::ones({1, 4});
  EXPECT_THROW(synthesise_view(image, torch::ones({1, 1, 5, 6}), K, torch::ones({1, 4, 4})),
               std::invalid_argument);
  EXPECT_THROW(synthesise_view(image, depth, torch::ones({4}), torch::ones({1, 4, 4})),
               std::invalid_argument);
  EXPECT_THROW(synthesise_view(image, depth, K, torch::ones({4, 4})), std::invalid_argument);
}

}  // namespace
}  // namespace alight
