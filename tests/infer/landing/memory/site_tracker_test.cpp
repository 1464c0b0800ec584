#include "infer/landing/memory/site_tracker.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "infer/landing/site_selector.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::attitude;
using scenes::camera_of;

constexpr std::int64_t kImage_ns = 50'000'000;

/// A vehicle over a ground with one good field: a disc at `field`, all else is unknown.
class SiteTrackerTest : public testing::Test {
 protected:
  Eigen::Isometry3d pose(double x_m, double y_m, double height_m, double tilt_rad = 0) const {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.linear() = attitude(tilt_rad, 0);
    T_world_camera.translation() = Eigen::Vector3d(x_m, y_m, height_m);
    return T_world_camera;
  }
  cv::Mat depth_from(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector2d& field,
                     double radius_m) const {
    cv::Mat depth = scenes::level_ground_seen(k_, T_world_camera.translation().z(), T_world_camera.linear());
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const Eigen::Vector3d p_world =
            T_world_camera * (k_.ray(u, v) * static_cast<double>(depth.at<float>(v, u)));
        if ((p_world.head<2>() - field).norm() > radius_m) depth.at<float>(v, u) = 0;
      }
    }
    return depth;
  }
  SiteDecision frame(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector2d& field,
                     double radius_m = 4) {
    t_ns_ += kImage_ns;
    return tracker_.update(
        t_ns_, selector_.select(depth_from(T_world_camera, field, radius_m), T_world_camera.linear()),
        T_world_camera);
  }
  SiteDecision blind() { return tracker_.update_without_depth(t_ns_ += kImage_ns); }

  PinholeIntrinsics k_ = camera_of(352, 352);
  SiteSelector selector_{{}, k_};
  SiteTracker tracker_{{}, SiteRules{}.min_radius_m, k_};
  std::int64_t t_ns_ = 0;
};

TEST_F(SiteTrackerTest, CountsAfterFiveConsecutiveFrames) {
  for (int i = 1; i <= 7; ++i) {
    const SiteDecision decision = frame(pose(0, 0, 20), {1, 2});
    ASSERT_TRUE(decision.site);
    EXPECT_EQ(decision.site->frames, i);
    EXPECT_EQ(decision.site->accepted, i >= 5);
  }
}

TEST_F(SiteTrackerTest, PlaceInTheWorldIsRightAndStaysWhileTheVehicleMovesAndTilts) {
  const SiteDecision first = frame(pose(0, 0, 20), {1, 2});
  ASSERT_TRUE(first.site);
  EXPECT_NEAR(first.site->p_world.x(), 1, 0.15);
  EXPECT_NEAR(first.site->p_world.y(), 2, 0.15);
  EXPECT_NEAR(first.site->p_world.z(), 0, 0.02);
  for (int i = 1; i <= 6; ++i) {
    const SiteDecision decision = frame(pose(0.3 * i, -0.2 * i, 20 - 0.5 * i, 0.02 * i), {1, 2});
    ASSERT_TRUE(decision.site) << i;
    EXPECT_EQ(decision.site->frames, i + 1);
    EXPECT_EQ(decision.site->p_world.head<2>(), first.site->p_world.head<2>());
    EXPECT_NEAR(decision.site->p_world.z(), 0, 0.05);
  }
}

TEST_F(SiteTrackerTest, KeepsItsSiteWhenALargerOneAppears) {
  frame(pose(0, 0, 20), {1, 2}, 3.5);
  const SiteDecision decision = frame(pose(0, 0, 20), {0, 0}, 7);
  ASSERT_TRUE(decision.site);
  EXPECT_NEAR(decision.site->p_world.x(), 1, 0.15);
  EXPECT_EQ(decision.site->frames, 2);
}

TEST_F(SiteTrackerTest, StartsAnewWhenTheSiteTurnsUnsafe) {
  for (int i = 0; i < 4; ++i) frame(pose(0, 0, 20), {3, 3}, 3.5);
  const SiteDecision moved = frame(pose(0, 0, 20), {-3, -3}, 3.5);
  ASSERT_TRUE(moved.site);
  EXPECT_EQ(moved.site->frames, 1);
  EXPECT_FALSE(moved.site->accepted);
  EXPECT_NEAR(moved.site->p_world.x(), -3, 0.15);
}

TEST_F(SiteTrackerTest, OneBadFrameBreaksTheRow) {
  for (int i = 0; i < 4; ++i) frame(pose(0, 0, 20), {1, 2});
  EXPECT_FALSE(frame(pose(0, 0, 20), {1, 2}, 1).site);
  const SiteDecision after = frame(pose(0, 0, 20), {1, 2});
  EXPECT_EQ(after.site->frames, 1);
}

TEST_F(SiteTrackerTest, FrameWithoutDepthBreaksTheRowAndRemembersThePlace) {
  for (int i = 0; i < 6; ++i) frame(pose(0, 0, 20), {1, 2}, 3.5);
  const SiteDecision nothing = blind();
  EXPECT_FALSE(nothing.site);
  EXPECT_FALSE(nothing.wander);
  const SiteDecision after = frame(pose(0, 0, 20), {0, 0}, 7);
  ASSERT_TRUE(after.site);
  EXPECT_EQ(after.site->frames, 1);
  EXPECT_NEAR(after.site->p_world.x(), 1, 0.15);
}

TEST_F(SiteTrackerTest, PauseBreaksTheRow) {
  for (int i = 0; i < 4; ++i) frame(pose(0, 0, 20), {1, 2});
  t_ns_ += 2 * kNanosecondsPerSecond;
  EXPECT_EQ(frame(pose(0, 0, 20), {1, 2}).site->frames, 1);
}

TEST_F(SiteTrackerTest, GroundThatJumpsInHeightIsAnotherGround) {
  for (int i = 0; i < 5; ++i) frame(pose(0, 0, 20), {1, 2});
  // The same picture from a pose that claims 3 m more height.
  t_ns_ += kImage_ns;
  const Eigen::Isometry3d T = pose(0, 0, 20);
  const SiteSelection selection = selector_.select(depth_from(T, {1, 2}, 4), T.linear());
  const SiteDecision decision = tracker_.update(t_ns_, selection, pose(0, 0, 23));
  ASSERT_TRUE(decision.site);
  EXPECT_EQ(decision.site->frames, 1);
}

TEST_F(SiteTrackerTest, WandersAfterFiveSecondsWithoutASiteThatCounts) {
  int frames = 0;
  while (!blind().wander && frames < 1000) ++frames;
  EXPECT_NEAR(frames * to_seconds(kImage_ns), 5.0, 0.06);
  for (int i = 1; i <= 4; ++i)
    EXPECT_TRUE(frame(pose(0, 0, 20), {1, 2}).wander) << "four frames do not count";
  EXPECT_FALSE(frame(pose(0, 0, 20), {1, 2}).wander);
  frames = 0;
  while (!blind().wander && frames < 1000) ++frames;
  EXPECT_NEAR(frames * to_seconds(kImage_ns), 5.0, 0.06);
}

TEST_F(SiteTrackerTest, RefusesToGoBackInTime) {
  blind();
  EXPECT_THROW(tracker_.update_without_depth(t_ns_), std::invalid_argument);
  EXPECT_THROW(tracker_.update_without_depth(t_ns_ - 1), std::invalid_argument);
}

}  // namespace
}  // namespace alight
