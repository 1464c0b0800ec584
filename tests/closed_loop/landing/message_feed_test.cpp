#include "closed_loop/landing/message_feed.hpp"

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sim/sensors/livox_scan.hpp"

namespace alight::closed_loop {
namespace {

class MessageFeedTest : public ::testing::Test {
 protected:
  Rig rig_ = load_rig(std::filesystem::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml");
  MessageFeed feed_{rig_, LogConfig{}};
  static constexpr std::int64_t kStamp_ns = 1'700'000'000'250'000'000;
};

TEST_F(MessageFeedTest, AScanArrivesPointByPointAtItsOwnTimes) {
  sim::LidarScan scan;
  scan.shots.resize(3);
  scan.shots[0].p_lidar = {10, 1, 2};
  scan.shots[2].p_lidar = {20, -1, 0.5F};  // the shot between has no echo
  const auto messages =
      feed_.add({rig_.lidar0->topic, kStamp_ns + 1000, sim::lidar_message(scan, kStamp_ns, 7)});
  ASSERT_EQ(messages.size(), 1u);
  const auto& packet = std::get<LidarPacket>(messages.front());
  ASSERT_EQ(packet.returns.size(), 2u);
  EXPECT_EQ(packet.returns[0].p_lidar, scan.shots[0].p_lidar);
  EXPECT_EQ(packet.returns[1].t_ns - packet.returns[0].t_ns, 2 * sim::kLivoxShotPeriod_ns);
}

TEST_F(MessageFeedTest, TwoCamerasMakeAFrameAndUnreadTopicsNothing) {
  const cv::Mat grey(400, 640, CV_8UC3, cv::Scalar::all(120));
  const sim::RecordedMessage left{rig_.cam0.topic + "/compressed", kStamp_ns,
                                  sim::jpeg_message(grey, 90, "l", kStamp_ns, 0)};
  const sim::RecordedMessage right{rig_.cam1->topic + "/compressed", kStamp_ns,
                                   sim::jpeg_message(grey, 90, "r", kStamp_ns, 0)};
  EXPECT_TRUE(feed_.add(left).empty());
  const auto messages = feed_.add(right);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(std::get<StereoFrame>(messages.front()).left.size(), grey.size());
  EXPECT_TRUE(feed_.add({sim::kImuTopic, kStamp_ns, sensor_msgs::Imu{}}).empty());
}

}  // namespace
}  // namespace alight::closed_loop
