#include "infer/depth/accumulator.hpp"

#include <gtest/gtest.h>

#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

using fakes::kMillisecond;
using fakes::kStart_ns;

WorldPacketPtr packet_of(std::int64_t end_ms, int points = 10) {
  auto packet = std::make_shared<WorldPacket>();
  packet->end_ns = end_ms * kMillisecond;
  packet->begin_ns = (end_ms - 100) * kMillisecond;
  packet->duration_s = 0.1;
  packet->points.resize(static_cast<std::size_t>(points));
  return packet;
}

std::vector<std::int64_t> ends_ms(const std::vector<WorldPacketPtr>& packets) {
  std::vector<std::int64_t> ends;
  for (const auto& packet : packets) ends.push_back(packet->end_ns / kMillisecond);
  return ends;
}

TEST(Accumulator, GivesTheNewestPastFirstAndOneMoreToHoldOut) {
  Accumulator accumulator(1000);
  for (const int end : {1000, 1100, 1200, 1300, 1400, 1500}) accumulator.add(packet_of(end));
  EXPECT_EQ(ends_ms(accumulator.before(1450 * kMillisecond, 0.2, 10)),
            (std::vector<std::int64_t>{1400, 1300, 1200}));
  EXPECT_EQ(ends_ms(accumulator.before(1400 * kMillisecond, 0.1, 10)),
            (std::vector<std::int64_t>{1400, 1300}));
  EXPECT_EQ(ends_ms(accumulator.after(1400 * kMillisecond)), (std::vector<std::int64_t>{1500}));
  EXPECT_EQ(ends_ms(accumulator.before(1450 * kMillisecond, 5, 0.3)),
            (std::vector<std::int64_t>{1400, 1300}));
}

TEST(Accumulator, MemoryIsBoundedByTimeAndByPoints) {
  Accumulator accumulator(95);
  for (int end = 100; end <= 100000; end += 100) accumulator.add(packet_of(end));
  EXPECT_EQ(accumulator.packets(), 9U);
  EXPECT_EQ(accumulator.points(), 90U);
  accumulator.forget_before(99700 * kMillisecond);
  EXPECT_EQ(accumulator.packets(), 4U);
  accumulator.add(packet_of(100100, 5000));  // larger than the bound: kept alone
  EXPECT_EQ(accumulator.packets(), 1U);
}

TEST(Accumulator, LatePacketsFindTheirPlace) {
  Accumulator accumulator(1000);
  for (const int end : {1000, 1200, 1100}) accumulator.add(packet_of(end));
  EXPECT_EQ(ends_ms(accumulator.after(0)), (std::vector<std::int64_t>{1000, 1100, 1200}));
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
