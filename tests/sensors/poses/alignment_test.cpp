#include "sensors/poses/alignment.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

Trajectory straight_flight() {
  Trajectory trajectory(0.25);
  for (int i = 0; i <= 10; ++i) {
    trajectory.add_attitude(i * 100,
                            Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitZ())));
    trajectory.add_position(i * 100, Eigen::Vector3d(i, 0, 0));
  }
  return trajectory;
}

TEST(AlignPoints, EachPointTakesThePoseOfItsOwnTime) {
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.translation() << 0, 0, -0.5;
  const std::vector<LidarReturn> returns = {{0, {1, 0, 0}, 0}, {250, {1, 0, 0}, 0}};
  const AlignedPoints aligned = align_points(returns, straight_flight(), T_imu_lidar);
  ASSERT_EQ(aligned.points.size(), 2u);
  EXPECT_EQ(aligned.without_pose, 0);
  EXPECT_TRUE(aligned.points[0].p_world.isApprox(Eigen::Vector3d(1, 0, -0.5), 1e-12));
  const Eigen::Vector3d expected(2.5 + std::cos(0.025), std::sin(0.025), -0.5);
  EXPECT_TRUE(aligned.points[1].p_world.isApprox(expected, 1e-12)) << aligned.points[1].p_world.transpose();
  EXPECT_EQ(aligned.points[1].t_ns, 250);
}

/// METHOD step 2 in one formula against the way through the world frame.
TEST(AlignPoints, IsThePapersTransform) {
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T_imu_lidar.translation() << 0.1, -0.2, 0.3;
  const Trajectory trajectory = straight_flight();
  const Eigen::Vector3f p_lidar1(5, -1, 2);
  const auto aligned = align_points({{730, p_lidar1, 0}}, trajectory, T_imu_lidar);
  const Eigen::Isometry3d T_world_imu0 = *trajectory.T_world_imu(420);
  const Eigen::Isometry3d T_world_imu1 = *trajectory.T_world_imu(730);
  const Eigen::Isometry3d T_lidar_imu = T_imu_lidar.inverse();
  const Eigen::Isometry3d T_lidar0_lidar1 =
      T_lidar_imu * T_world_imu0.inverse() * T_world_imu1 * T_lidar_imu.inverse();
  const Eigen::Vector3d by_world = T_lidar_imu * (T_world_imu0.inverse() * aligned.points.at(0).p_world);
  EXPECT_TRUE(by_world.isApprox(T_lidar0_lidar1 * p_lidar1.cast<double>(), 1e-12));
}

TEST(AlignPoints, NeverExtrapolates) {
  const std::vector<LidarReturn> returns = {{-1, {1, 0, 0}, 0}, {1000, {1, 0, 0}, 0}, {1001, {1, 0, 0}, 0}};
  const AlignedPoints aligned = align_points(returns, straight_flight(), Eigen::Isometry3d::Identity());
  EXPECT_EQ(aligned.points.size(), 1u);
  EXPECT_EQ(aligned.without_pose, 2);
}

TEST(HeightTrack, InterpolatesAndKnowsItsLimits) {
  HeightTrack track;
  EXPECT_TRUE(std::isnan(track.at(0)));
  track.add({0, 10});
  track.add({100, 20});
  track.add({50, 99});  // not later than the last: dropped
  EXPECT_DOUBLE_EQ(track.at(0), 10);
  EXPECT_DOUBLE_EQ(track.at(25), 12.5);
  EXPECT_TRUE(std::isnan(track.at(101)));
  EXPECT_TRUE(std::isnan(track.at(-1)));
  track.add({100 + 2 * kNanosecondsPerSecond, 30});
  EXPECT_TRUE(std::isnan(track.at(200)));
  track.forget_before(100);
  EXPECT_TRUE(std::isnan(track.at(25)));
  EXPECT_DOUBLE_EQ(track.at(100), 20);
}

TEST(PointWindow, ProjectsOnlyItsSpanOfTime) {
  const PinholeIntrinsics intrinsics{10, 10, 4.5, 4.5, 10, 10};
  PointWindow window;
  window.add({{0, {0, 0, 5}}, {100, {1, 0, 5}}});
  window.add({});
  window.add({{200, {-1, 0, 5}}, {300, {0, 1, 5}}});
  const auto count = [&](std::int64_t begin_ns, std::int64_t end_ns) {
    SparseDepth out = SparseDepth::empty(intrinsics.size());
    return window.project(begin_ns, end_ns, Eigen::Isometry3d::Identity(), intrinsics, 0, {0.5, 100}, out);
  };
  EXPECT_EQ(count(0, 300), 4);
  EXPECT_EQ(count(1, 299), 2);
  EXPECT_EQ(count(100, 100), 1);
  EXPECT_EQ(count(301, 400), 0);
  window.forget_before(101);
  EXPECT_EQ(count(0, 300), 2);
}

TEST(HeightTrack, TakesTheLatestOnlyWhileItIsFresh) {
  HeightTrack track;
  track.add({1'000, 10.0});
  track.add({2'000, 12.0});
  EXPECT_EQ(track.at_or_latest(1'500, 100), 11.0);
  EXPECT_EQ(track.at_or_latest(2'100, 100), 12.0);
  EXPECT_TRUE(std::isnan(track.at_or_latest(2'101, 100)));
  EXPECT_TRUE(std::isnan(track.at_or_latest(900, 100)));
}

}  // namespace
}  // namespace alight
