#include "models/inputs/sparse_fill.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(SparseFill, GivenValuesStayAsTheyAre) {
  torch::manual_seed(1);
  const torch::Tensor value = torch::rand({2, 1, 13, 17});
  const torch::Tensor valid = (torch::rand({2, 1, 13, 17}) < 0.2).to(torch::kFloat32);
  const SparseFill fill = fill_pyramid(value, valid);
  EXPECT_TRUE(torch::equal(fill.value * valid, value * valid));
  EXPECT_TRUE(torch::equal(fill.coarseness * valid, torch::zeros_like(valid)));
  EXPECT_GT((fill.coarseness + valid).min().item<float>(), 0);
}

TEST(SparseFill, OneValueFillsTheWholeMap) {
  torch::Tensor value = torch::zeros({1, 1, 11, 7});
  torch::Tensor valid = torch::zeros({1, 1, 11, 7});
  value[0][0][9][2] = 0.75F;
  valid[0][0][9][2] = 1;
  const SparseFill fill = fill_pyramid(value, valid);
  EXPECT_TRUE(torch::allclose(fill.value, torch::full_like(value, 0.75)));
}

TEST(SparseFill, StaysWithinTheValuesGiven) {
  torch::manual_seed(2);
  const torch::Tensor value = torch::rand({1, 1, 33, 41}) + 3;
  const torch::Tensor valid = (torch::rand({1, 1, 33, 41}) < 0.05).to(torch::kFloat32);
  const torch::Tensor filled = fill_pyramid(value, valid).value;
  EXPECT_GE(filled.min().item<float>(), 3 - 1e-5);
  EXPECT_LE(filled.max().item<float>(), 4 + 1e-5);
}

TEST(SparseFill, FollowsASlopeBetweenThePoints) {
  const torch::Tensor value = torch::arange(64, torch::kFloat32).view({1, 1, 1, 64}).expand({1, 1, 64, 64});
  torch::manual_seed(3);
  const torch::Tensor valid = (torch::rand({1, 1, 64, 64}) < 0.25).to(torch::kFloat32);
  const torch::Tensor error = (fill_pyramid(value, valid).value - value).abs();
  EXPECT_LT(error.mean().item<float>(), 0.5);  // pixels; half the distance to the next point
}

TEST(SparseFill, SmoothingKeepsWhatIsGivenAndBringsTheFillNearerToASlope) {
  const torch::Tensor value =
      (torch::arange(64).view({1, 1, 1, 64}) + 0.5 * torch::arange(64).view({1, 1, 64, 1}))
          .to(torch::kFloat32);
  torch::manual_seed(3);
  const torch::Tensor valid = (torch::rand({1, 1, 64, 64}) < 0.1).to(torch::kFloat32);
  const torch::Tensor smooth = fill_pyramid(value, valid, 4).value;
  EXPECT_TRUE(torch::equal(smooth * valid, value * valid));
  const auto error = [&](const torch::Tensor& filled) {  // between the points, where nothing is extrapolated
    return (filled - value).slice(2, 8, 56).slice(3, 8, 56).square().mean().item<double>();
  };
  EXPECT_LT(error(smooth), 0.5 * error(fill_pyramid(value, valid).value));
}

TEST(SparseFill, EmptyMapIsZeroAndCoarsest) {
  const torch::Tensor none = torch::zeros({1, 1, 5, 6});
  const SparseFill fill = fill_pyramid(none, none);
  EXPECT_EQ(fill.value.abs().max().item<float>(), 0);
  EXPECT_EQ(fill.coarseness.min().item<float>(), 1);
}

TEST(SparseFill, SamplesDoNotMix) {
  torch::Tensor value = torch::ones({2, 1, 8, 8});
  torch::Tensor valid = torch::zeros({2, 1, 8, 8});
  valid[1] = 1;
  const SparseFill fill = fill_pyramid(value, valid);
  EXPECT_EQ(fill.value[0].abs().max().item<float>(), 0);
  EXPECT_EQ(fill.value[1].min().item<float>(), 1);
}

/// Planes in float32, tensors in float64: two ways to the same fill.
TEST(SparseFill, PlanesAndTensorsAgree) {
  torch::manual_seed(4);
  for (const auto& [height, width] : {std::pair{1, 1}, {1, 9}, {7, 1}, {13, 17}, {64, 96}, {35, 50}}) {
    for (const double share : {0.0, 0.02, 0.3, 1.0}) {
      const torch::Tensor value = torch::randn({2, 1, height, width});
      const torch::Tensor valid = (torch::rand({2, 1, height, width}) < share).to(torch::kFloat32);
      for (const int smoothing : {0, 3}) {
        const SparseFill planes = fill_pyramid(value, valid, smoothing);
        const SparseFill tensors =
            fill_pyramid(value.to(torch::kFloat64), valid.to(torch::kFloat64), smoothing);
        const auto differ = [](const torch::Tensor& a, const torch::Tensor& b) {
          return (a.to(torch::kFloat64) - b).abs().max().item<double>();
        };
        EXPECT_LT(differ(planes.value, tensors.value), 1e-5) << height << "x" << width << " " << share;
        EXPECT_LT(differ(planes.coarseness, tensors.coarseness), 1e-5)
            << height << "x" << width << " " << share;
      }
    }
  }
}

}  // namespace
}  // namespace alight
