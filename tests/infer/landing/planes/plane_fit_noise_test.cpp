// plane_fit and the noise of a LiDAR's points: what is noise, and what still is a stone.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "infer/landing/ground/elevation_raster.hpp"
#include "infer/landing/planes/plane_fit.hpp"
#include "infer/landing/site_selector.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

constexpr double kNoise_m = 0.02;  // of the Mid-40

Eigen::Isometry3d camera_over(double height_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = scenes::attitude(to_radians(4), to_radians(-3), 0.4);
  T.translation() = Eigen::Vector3d(3.1, -2.2, height_m);
  return T;
}

const PinholeIntrinsics& camera() {
  static const PinholeIntrinsics k = scenes::camera_of(352, 352);
  return k;
}

/// Depth of level ground with a round stone that stands out of it by `stone_m` at its middle, `reach_m` in radius. The
/// stone is seen from straight above: its sides hide nothing.
cv::Mat ground_with_stone(const Eigen::Isometry3d& T, const Eigen::Vector2d& at_m, double stone_m,
                          double reach_m) {
  cv::Mat depth = scenes::level_ground_seen(camera(), T.translation().z(), T.linear());
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = T.linear() * camera().ray(u, v);
      const Eigen::Vector3d p = T.translation() + ray * static_cast<double>(depth.at<float>(v, u));
      const double share = (p.head<2>() - at_m).norm() / reach_m;
      if (share < 1)
        depth.at<float>(v, u) += static_cast<float>(stone_m * std::sqrt(1 - share * share) / ray.z());
    }
  }
  return depth;
}

SiteSelector noisy_planes(double noise_m) {
  SiteSelectionConfig config;
  config.method = LandingMethod::kPlaneFit;
  config.plane_fit.noise_m = noise_m;
  return SiteSelector(config, camera());
}

double safe_share(const SiteSelection& selection) {
  return static_cast<double>(cv::countNonZero(selection.safe)) / cv::countNonZero(selection.terrain.known);
}

class PlaneFitNoise : public testing::TestWithParam<double> {};

TEST_P(PlaneFitNoise, LevelGroundStaysSafe) {
  const Eigen::Isometry3d T = camera_over(GetParam());
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const cv::Mat depth =
        scenes::with_noise(scenes::level_ground_seen(camera(), GetParam(), T.linear()), kNoise_m, seed);
    const SiteSelection selection = noisy_planes(kNoise_m).select(depth, T);
    EXPECT_GT(safe_share(selection), 0.99) << seed;
    if (GetParam() > 17)
      EXPECT_LT(safe_share(noisy_planes(0).select(depth, T)), 0.9) << "the noise is no noise";
  }
}

/// Wherever the stone lies relative to the cells, no frame takes its place for safe.
TEST_P(PlaneFitNoise, AStoneIsSeenThroughIt) {
  const Eigen::Isometry3d T = camera_over(GetParam());
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Eigen::Vector2d at_m =
        T.translation().head<2>() + Eigen::Vector2d(0.013 * seed - 0.3, 0.4 - 0.017 * seed);
    for (const double stone_m : {0.15, 0.20}) {
      const cv::Mat depth = scenes::with_noise(ground_with_stone(T, at_m, stone_m, stone_m), kNoise_m, seed);
      const SiteSelection selection = noisy_planes(kNoise_m).select(depth, T);
      int column = 0;
      int row = 0;
      ASSERT_TRUE(selection.ground.raster.cell_at(at_m.x(), at_m.y(), column, row));
      EXPECT_EQ(selection.ground.safe.at<std::uint8_t>(row, column), 0) << stone_m << " m, seed " << seed;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Heights, PlaneFitNoise, testing::Values(4.0, 9.0, 18.0, 28.0));

/// What is a pixel wide has no mean: its own points have to stand out.
TEST(PlaneFitNoise, AWireAPixelWideIsSeenThroughIt) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = scenes::attitude(0, 0);
  T.translation().z() = 20;
  cv::Mat depth = scenes::level_ground(camera(), 20);
  depth.col(200).setTo(19.8);
  const SiteSelection selection = noisy_planes(kNoise_m).select(scenes::with_noise(depth, kNoise_m, 3), T);
  EXPECT_EQ(cv::countNonZero(selection.safe.col(200)), 0);
  EXPECT_GT(safe_share(selection), 0.7);
}

TEST(RasterizeWithNoise, BoundsAreThePointsLessWhatNoiseExplains) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = scenes::attitude(0, 0);
  T.translation().z() = 44;  // 0.1 m a pixel: the window is 3 x 3, a cell of 1 m holds a hundred
  cv::Mat depth = scenes::level_ground(camera(), 44);
  // A single point 1 m up, a block of 5 x 5 pixels 0.5 m up.
  depth.at<float>(100, 100) = 43;
  depth(cv::Rect(250, 250, 5, 5)).setTo(43.5);
  const ElevationRaster raster = rasterize(depth, camera(), T, 1.0, 60, 0.02);
  const auto top_at = [&](int u, int v) {
    const Eigen::Vector3d p = T * (camera().ray(u, v) * static_cast<double>(depth.at<float>(v, u)));
    int column = 0;
    int row = 0;
    EXPECT_TRUE(raster.cell_at(p.x(), p.y(), column, row));
    return raster.top_m.at<float>(row, column);
  };
  EXPECT_NEAR(top_at(100, 100), 1.0 - 2.5 * 0.02, 1e-4);
  EXPECT_NEAR(top_at(252, 252), 0.5 - 2.5 * 0.02 / 3, 1e-3);
  // Level ground: the bounds lie inside the points, and are cut off at the mean.
  EXPECT_NEAR(top_at(30, 300), 0, 1e-4);
  double highest_bottom = 0;
  cv::minMaxLoc(raster.bottom_m - raster.mean_m, nullptr, &highest_bottom, nullptr, nullptr, raster.known);
  EXPECT_LE(highest_bottom, 0);
}

}  // namespace
}  // namespace alight
