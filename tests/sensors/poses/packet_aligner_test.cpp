#include "sensors/poses/packet_aligner.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr std::int64_t kOneMillisecond = 1'000'000;

class PacketAlignerTest : public ::testing::Test {
 protected:
  /// Level, east by a metre a second, every 10 ms.
  void poses(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms; ms <= to_ms; ms += 10) {
      aligner_.add(AttitudeSample{ms * kOneMillisecond, Eigen::Quaterniond::Identity()});
      aligner_.add(
          PositionSample{ms * kOneMillisecond, Eigen::Vector3d(static_cast<double>(ms) / 1000, 0, 0)});
    }
  }
  /// Three points, the last 100 ms after the first.
  void packet(std::int64_t ms) {
    LidarPacket packet;
    packet.t_ns = ms * kOneMillisecond;
    for (const std::int64_t after_ms : {0, 50, 100})
      packet.returns.push_back({(ms + after_ms) * kOneMillisecond, Eigen::Vector3f(1, 0, 0), 0});
    aligner_.add(std::move(packet));
  }

  PacketAligner aligner_{{0.1, 0.5}, Eigen::Isometry3d::Identity()};
};

TEST_F(PacketAlignerTest, APacketWaitsForThePoseOfItsLastPointAndNoLonger) {
  poses(0, 190);
  packet(100);
  EXPECT_FALSE(aligner_.next());
  poses(200, 200);
  const auto placed = aligner_.next();
  ASSERT_TRUE(placed);
  ASSERT_EQ(placed->points.size(), 3u);
  EXPECT_NEAR(placed->points[1].p_world.x(), 1.15, 1e-12);
  EXPECT_EQ(aligner_.placed_until_ns(), 200 * kOneMillisecond);
  EXPECT_TRUE(aligner_.dropped().empty());
}

TEST_F(PacketAlignerTest, PacketsLeaveInOrderOfArrivalAndWithoutPoseOnceTheyAreLate) {
  poses(0, 150);
  packet(100);
  packet(0);
  EXPECT_FALSE(aligner_.next()) << "the second has its poses, but stands behind";
  aligner_.saw(700 * kOneMillisecond);
  EXPECT_FALSE(aligner_.next()) << "late by half a second at 700 ms, and not by more";
  aligner_.saw(701 * kOneMillisecond);
  const auto late = aligner_.next();
  ASSERT_TRUE(late);
  EXPECT_EQ(late->points.size(), 2u);
  EXPECT_EQ(late->without_pose, 1);
  EXPECT_EQ(aligner_.dropped().at("LiDAR points without a pose"), 1);
  const auto behind = aligner_.next();
  ASSERT_TRUE(behind);
  EXPECT_EQ(behind->points.size(), 3u);
  EXPECT_EQ(aligner_.placed_until_ns(), 200 * kOneMillisecond) << "does not go back";
}

TEST_F(PacketAlignerTest, AtTheEndNothingWaits) {
  poses(0, 150);
  packet(100);
  EXPECT_FALSE(aligner_.settled(200 * kOneMillisecond));
  aligner_.finish();
  EXPECT_TRUE(aligner_.settled(200 * kOneMillisecond));
  EXPECT_EQ(aligner_.next().value().points.size(), 2u);
  EXPECT_FALSE(aligner_.next());
}

TEST_F(PacketAlignerTest, CountsWhatItLeavesOut) {
  poses(0, 10);
  poses(0, 10);
  aligner_.add(LidarPacket{20 * kOneMillisecond, {}});
  EXPECT_EQ(aligner_.dropped().at("attitudes not finite or not later than the one before"), 2);
  EXPECT_EQ(aligner_.dropped().at("positions not finite or not later than the one before"), 2);
  EXPECT_EQ(aligner_.dropped().at("LiDAR packets without returns"), 1);
  EXPECT_EQ(aligner_.now_ns(), 20 * kOneMillisecond);
}

TEST_F(PacketAlignerTest, PosesThatNobodyAsksForAreForgotten) {
  poses(0, 1000);
  ASSERT_TRUE(aligner_.T_world_imu(100 * kOneMillisecond));
  aligner_.forget_before(500 * kOneMillisecond);
  EXPECT_FALSE(aligner_.T_world_imu(100 * kOneMillisecond));
  EXPECT_TRUE(aligner_.T_world_imu(600 * kOneMillisecond));
}

}  // namespace
}  // namespace alight
