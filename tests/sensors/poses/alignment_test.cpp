#include "sensors/poses/alignment.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

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

TEST(ToWorld, EveryPointGoesThroughItsOwnPose) {
  Trajectory trajectory(0.5);
  for (int i = 0; i <= 10; ++i) {
    trajectory.add_attitude(i * 100 * kMillisecond, Eigen::Quaterniond::Identity());
    trajectory.add_position(i * 100 * kMillisecond, Eigen::Vector3d(i, 0, 50));  // 10 m/s
  }
  LidarPacket packet;
  packet.t_ns = 200 * kMillisecond;
  for (int i = 0; i < 100; ++i) {
    packet.returns.push_back({200 * kMillisecond + i * kMillisecond, Eigen::Vector3f(1, 2, 3), 0});
  }
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.translation() = Eigen::Vector3d(0, 0, -0.5);
  const WorldPacket world = to_world(packet, trajectory, T_imu_lidar, {});
  ASSERT_EQ(world.points.size(), 100U);
  EXPECT_NEAR(world.duration_s, 0.099, 1e-9);
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(
        (world.points[static_cast<std::size_t>(i)].p_world - Eigen::Vector3d(3 + 0.01 * i, 2, 52.5)).norm(),
        1e-9);
  }
}

TEST(ToWorld, CountsPointsWithoutAPose) {
  Trajectory trajectory(0.5);
  trajectory.add_attitude(0, Eigen::Quaterniond::Identity());
  trajectory.add_position(0, Eigen::Vector3d::Zero());
  trajectory.add_attitude(50 * kMillisecond, Eigen::Quaterniond::Identity());
  trajectory.add_position(50 * kMillisecond, Eigen::Vector3d::Zero());
  LidarPacket packet;
  for (int i = 0; i < 10; ++i) packet.returns.push_back({i * 10 * kMillisecond, Eigen::Vector3f(1, 0, 0), 0});
  const WorldPacket world = to_world(packet, trajectory, Eigen::Isometry3d::Identity(), {});
  EXPECT_EQ(world.points.size(), 6U);
  EXPECT_EQ(world.without_pose, 4);
}

TEST(ToWorld, PacketsWithoutPointTimesLastSinceTheOneBefore) {
  Trajectory trajectory(0.5);
  LidarPacket packet;
  packet.t_ns = 500 * kMillisecond;
  packet.returns.resize(3);
  for (auto& echo : packet.returns) echo.t_ns = packet.t_ns;
  EXPECT_NEAR(to_world(packet, trajectory, Eigen::Isometry3d::Identity(), 400 * kMillisecond).duration_s, 0.1,
              1e-9);
  EXPECT_NEAR(to_world(packet, trajectory, Eigen::Isometry3d::Identity(), 0).duration_s, 0.2, 1e-9)
      << "a pause";
  EXPECT_EQ(to_world(packet, trajectory, Eigen::Isometry3d::Identity(), {}).duration_s, 0);
}

}  // namespace
}  // namespace alight
