#include "infer/mission/site_check.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

constexpr double kHeight_m = 12;

class SiteCheckTest : public ::testing::Test {
 protected:
  SiteCheckTest() { T_world_camera_.linear() = scenes::attitude(0.03, -0.05); }

  SiteCheck check(const cv::Mat& level_depth_m, const Eigen::Vector3d& p_world, const SiteCheckRule& rule) {
    T_world_camera_.linear() = scenes::attitude(0, 0);
    T_world_camera_.translation() = Eigen::Vector3d(0, 0, kHeight_m);
    return check_site(selector_, selector_.select(level_depth_m, T_world_camera_.linear()), T_world_camera_,
                      p_world, rule);
  }

  PinholeIntrinsics camera_ = scenes::camera_of(352, 352);
  SiteSelector selector_{SiteSelectionConfig{}, camera_};
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity();
};

TEST_F(SiteCheckTest, LevelGroundIsSafeFromATiltedCamera) {
  T_world_camera_.translation() = Eigen::Vector3d(5, 7, kHeight_m);
  const cv::Mat depth = scenes::level_ground_seen(camera_, kHeight_m, T_world_camera_.linear());
  const auto selection = selector_.select(depth, T_world_camera_.linear());
  const SiteCheck result = check_site(selector_, selection, T_world_camera_, {5.5, 7, 0.2}, {});
  EXPECT_EQ(result.verdict, SiteVerdict::kSafe);
  EXPECT_GT(result.radius_m, 2.0);
  EXPECT_DOUBLE_EQ(result.unsafe_share, 0);
  EXPECT_NEAR(result.p_world.z(), 0, 0.02);  // the ground's height follows the depth
  EXPECT_NEAR((result.p_world - Eigen::Vector3d(5.5, 7, 0)).head<2>().norm(), 0, 0.05);
}

TEST_F(SiteCheckTest, ACarOnTheSiteIsUnsafe) {
  cv::Mat depth = scenes::level_ground(camera_, kHeight_m);
  scenes::change(
      depth, camera_, kHeight_m, [](double x, double y) { return std::abs(x) < 1 && std::abs(y) < 2; },
      static_cast<float>(kHeight_m - 1.5));
  const SiteCheck result = check(depth, {0, 0, 0}, {});
  EXPECT_EQ(result.verdict, SiteVerdict::kUnsafe);
}

TEST_F(SiteCheckTest, GroundThatHasSunkIsUnsafeEvenWhereItIsFlat) {
  const SiteCheck result = check(scenes::level_ground(camera_, kHeight_m), {0, 0, 1.5}, {});
  EXPECT_EQ(result.verdict, SiteVerdict::kUnsafe);
}

TEST_F(SiteCheckTest, ASiteMovesAwayFromAnObstacleBesideIt) {
  cv::Mat depth = scenes::level_ground(camera_, kHeight_m);
  // image right is world east
  scenes::change(
      depth, camera_, kHeight_m, [](double x, double) { return x > 1.2; }, static_cast<float>(kHeight_m - 2));
  SiteCheckRule rule;
  EXPECT_EQ(check(depth, {0, 0, 0}, rule).verdict, SiteVerdict::kUnsafe);
  rule.nudge_m = 2;
  const SiteCheck nudged = check(depth, {0, 0, 0}, rule);
  EXPECT_EQ(nudged.verdict, SiteVerdict::kSafe);
  EXPECT_GE(nudged.radius_m, rule.radius_m);
  EXPECT_LT(nudged.p_world.x(), -0.5);
  EXPECT_LE(nudged.p_world.head<2>().norm(), 2.05);
}

TEST_F(SiteCheckTest, WhatIsNotInViewIsUnseen) {
  const cv::Mat depth = scenes::level_ground(camera_, kHeight_m);
  EXPECT_EQ(check(depth, {30, 0, 0}, {}).verdict, SiteVerdict::kUnseen);
  EXPECT_EQ(check(cv::Mat::zeros(camera_.size(), CV_32FC1), {0, 0, 0}, {}).verdict, SiteVerdict::kUnseen);
  EXPECT_EQ(check(depth, {0, 0, kHeight_m + 1}, {}).verdict, SiteVerdict::kUnseen);  // above the camera
}

/// Near the ground a LiDAR's circle is smaller than the site.
TEST_F(SiteCheckTest, PartOfTheCircleIsEnoughOnlyWhereTheRuleSaysSo) {
  cv::Mat depth = scenes::level_ground(camera_, kHeight_m);
  scenes::change(depth, camera_, kHeight_m, [](double x, double y) { return std::hypot(x, y) > 1.6; }, 0.0F);
  SiteCheckRule rule;
  rule.radius_m = 1.5;
  EXPECT_NE(check(depth, {0, 0, 0}, rule).verdict, SiteVerdict::kSafe);
  rule.min_known_share = 0.05;
  EXPECT_EQ(check(depth, {0, 0, 0}, rule).verdict, SiteVerdict::kSafe);
  scenes::change(
      depth, camera_, kHeight_m, [](double x, double y) { return std::hypot(x, y) < 0.3; },
      static_cast<float>(kHeight_m - 1));
  EXPECT_EQ(check(depth, {0, 0, 0}, rule).verdict, SiteVerdict::kUnsafe);
}

}  // namespace
}  // namespace alight
