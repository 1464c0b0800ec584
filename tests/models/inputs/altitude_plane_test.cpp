#include "models/inputs/altitude_plane.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

torch::Tensor intrinsics_of() { return torch::tensor({50.0F, 40.0F, 10.0F, 6.0F}); }

TEST(AltitudePlane, LookingDownItIsTheHeightEverywhere) {
  const torch::Tensor plane = altitude_plane(12.5, Eigen::Vector3d::UnitZ(), intrinsics_of(), 13, 21, 100);
  EXPECT_TRUE(torch::allclose(plane, torch::full({1, 1, 13, 21}, 12.5)));
}

TEST(AltitudePlane, TiltedEveryPixelLiesOnTheGround) {
  const double tilt = 0.3;
  const Eigen::Vector3d down(std::sin(tilt), 0, std::cos(tilt));
  const torch::Tensor plane = altitude_plane(20, down, intrinsics_of(), 13, 21, 1000);
  for (const auto& [row, column] : {std::pair<int, int>{0, 0}, {6, 10}, {12, 20}, {3, 17}}) {
    const double z = plane[0][0][row][column].item<double>();
    const Eigen::Vector3d p_camera((column - 10.0) / 50 * z, (row - 6.0) / 40 * z, z);
    EXPECT_NEAR(p_camera.dot(down), 20, 1e-4);
  }
}

TEST(AltitudePlane, AboveTheHorizonIsTheLimit) {
  const torch::Tensor plane = altitude_plane(20, -Eigen::Vector3d::UnitZ(), intrinsics_of(), 3, 3, 150);
  EXPECT_TRUE(torch::equal(plane, torch::full({1, 1, 3, 3}, 150.0F)));
}

TEST(AltitudePlane, BatchHoldsEachSamplesPlaneAndZeroWhereTheHeightIsUnknown) {
  const torch::Tensor height_m = torch::tensor({12.5, std::nan(""), -1.0}, torch::kFloat64);
  const torch::Tensor down =
      torch::tensor({{0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}}, torch::kFloat64);
  const torch::Tensor planes = altitude_planes(height_m, down, intrinsics_of().expand({3, 4}), 13, 21, 100);
  ASSERT_EQ(planes.sizes(), (std::vector<std::int64_t>{3, 1, 13, 21}));
  EXPECT_TRUE(torch::allclose(planes[0], torch::full({1, 13, 21}, 12.5)));
  EXPECT_EQ(planes.slice(0, 1).abs().max().item<float>(), 0);
}

}  // namespace
}  // namespace alight
