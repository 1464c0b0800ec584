#include "models/depth_conversion.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

torch::Tensor intrinsics() { return torch::tensor({{4.0, 5.0, 1.0, 2.0}}, torch::kFloat64); }

TEST(DepthConversion, RayLengthsAreThoseOfThePinhole) {
  const torch::Tensor lengths = ray_lengths(intrinsics(), 4, 5);
  ASSERT_EQ(lengths.sizes(), (std::vector<std::int64_t>{1, 1, 4, 5}));
  EXPECT_DOUBLE_EQ((lengths[0][0][2][1].item<double>()), 1.0);  // the principal point
  EXPECT_NEAR((lengths[0][0][0][4].item<double>()), std::sqrt(1 + 0.75 * 0.75 + 0.4 * 0.4), 1e-12);
}

TEST(DepthConversion, RoundTripAndMissingStaysMissing) {
  torch::Tensor depth = torch::full({1, 1, 4, 5}, 7.0, torch::kFloat64);
  depth[0][0][1][1] = 0;
  const torch::Tensor range = plane_to_perspective(depth, intrinsics());
  EXPECT_GT((range[0][0][3][4].item<double>()), 7.0);
  EXPECT_EQ((range[0][0][1][1].item<double>()), 0.0);
  EXPECT_TRUE(torch::allclose(perspective_to_plane(range, intrinsics()), depth, 0, 1e-12));
}

TEST(DepthConversion, RefusesOtherShapes) {
  EXPECT_THROW(plane_to_perspective(torch::ones({4, 5}), intrinsics()), std::invalid_argument);
  EXPECT_THROW(ray_lengths(torch::ones({4}), 4, 5), std::invalid_argument);
}

}  // namespace
}  // namespace alight
