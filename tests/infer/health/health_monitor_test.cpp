#include "infer/health/health_monitor.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

using fakes::kStart_ns;

constexpr double kHeight_m = 12;

struct Outcome {
  HealthReport report;
  std::vector<LogMessage> passed;
};

Outcome judge(const std::vector<LogMessage>& messages, DepthMakers makers = DepthMakers::kImageAndLidar) {
  HealthMonitor monitor({}, fakes::small_rig(), makers);
  Outcome outcome;
  for (const LogMessage& message : messages) {
    for (LogMessage& passed : monitor.add(message)) outcome.passed.push_back(std::move(passed));
  }
  outcome.report = monitor.report();
  for (LogMessage& passed : monitor.finish()) outcome.passed.push_back(std::move(passed));
  return outcome;
}

std::vector<LogMessage> flight(const fakes::FlightPlan& plan = {}) {
  fakes::LevelWorld world(kHeight_m);
  return fakes::flight(world, plan);
}

template <class Message>
std::int64_t count(const std::vector<LogMessage>& messages) {
  return std::count_if(messages.begin(), messages.end(),
                       [](const LogMessage& m) { return std::holds_alternative<Message>(m); });
}

TEST(HealthMonitor, AHealthyFlightPassesWholeAndWithoutAFinding) {
  const auto messages = flight();
  const Outcome outcome = judge(messages);
  EXPECT_EQ(outcome.report.state, HealthState::kOk) << describe(outcome.report);
  EXPECT_EQ(outcome.passed.size(), messages.size());
  for (const LogMessage& message : outcome.passed) {
    if (const auto* frame = std::get_if<StereoFrame>(&message)) {
      EXPECT_FALSE(frame->left.empty());
      EXPECT_FALSE(frame->right.empty());
    }
  }
}

TEST(HealthMonitor, APacketComesBeforeThePoseThatSettlesIt) {
  const Outcome outcome = judge(flight());
  std::int64_t pose_ns = 0;
  for (const LogMessage& message : outcome.passed) {
    if (const auto* sample = std::get_if<AttitudeSample>(&message)) pose_ns = sample->t_ns;
    if (const auto* packet = std::get_if<LidarPacket>(&message)) {
      EXPECT_LE(pose_ns, packet->returns.back().t_ns + 20 * fakes::kMillisecond);
    }
  }
}

TEST(HealthMonitor, ALostLidarDegradesAndIsTheEndWithoutANetwork) {
  fakes::FlightPlan plan;
  plan.lidar_end_s = 1.2;
  const auto messages = flight(plan);
  const Outcome with = judge(messages);
  EXPECT_EQ(with.report.state, HealthState::kDegraded);
  EXPECT_EQ(describe(with.report), "lidar lost");
  EXPECT_EQ(judge(messages, DepthMakers::kLidar).report.state, HealthState::kFailed);
}

TEST(HealthMonitor, ALostPoseFails) {
  fakes::FlightPlan plan;
  plan.pose_end_s = 1.2;
  const Outcome outcome = judge(flight(plan));
  EXPECT_EQ(outcome.report.state, HealthState::kFailed);
  EXPECT_EQ(describe(outcome.report), "attitude lost, position lost");
}

TEST(HealthMonitor, ASilentCameraIsNoticedByTheOtherSensorsMessages) {
  auto messages = flight();
  messages.erase(std::remove_if(messages.begin(), messages.end(),
                                [](const LogMessage& m) {
                                  const auto* frame = std::get_if<StereoFrame>(&m);
                                  return frame != nullptr && frame->t_ns > kStart_ns + to_nanoseconds(1.0);
                                }),
                 messages.end());
  const Outcome outcome = judge(messages);
  EXPECT_EQ(describe(outcome.report), "left camera lost");
  EXPECT_EQ(outcome.report.state, HealthState::kDegraded);
}

TEST(HealthMonitor, SilenceOfAllIsSeenByWhoeverHasAClock) {
  HealthMonitor monitor({}, fakes::small_rig(), DepthMakers::kImageAndLidar);
  for (const LogMessage& message : flight()) monitor.add(message);
  EXPECT_EQ(monitor.report().state, HealthState::kOk);
  const HealthReport later = monitor.report(kStart_ns + to_nanoseconds(2.5));
  EXPECT_EQ(later.state, HealthState::kFailed);
  EXPECT_EQ(later.findings.size(), 4U) << describe(later);
  EXPECT_EQ(monitor.report().state, HealthState::kOk);
}

TEST(HealthMonitor, ABlackLeftCameraLeavesFramesWithoutImages) {
  auto messages = flight();
  for (LogMessage& message : messages) {
    auto* frame = std::get_if<StereoFrame>(&message);
    if (frame != nullptr && frame->t_ns > kStart_ns + to_nanoseconds(1.0))
      frame->left = cv::Mat(frame->left * 0.01);
  }
  const Outcome outcome = judge(messages);
  EXPECT_EQ(describe(outcome.report), "left camera black");
  for (const LogMessage& message : outcome.passed) {
    if (const auto* frame = std::get_if<StereoFrame>(&message)) {
      EXPECT_EQ(frame->left.empty(), frame->t_ns > kStart_ns + to_nanoseconds(1.0));
    }
  }
  EXPECT_EQ(count<StereoFrame>(outcome.passed), count<StereoFrame>(messages));
}

TEST(HealthMonitor, ALeapOfThePositionSpoilsTheLidarBeforeIt) {
  HealthMonitor monitor({}, fakes::small_rig(), DepthMakers::kImageAndLidar);
  for (const LogMessage& message : flight()) monitor.add(message);
  EXPECT_FALSE(monitor.take_lidar_spoiled());
  PositionSample leap = fakes::position_at(kStart_ns + to_nanoseconds(2.02));
  std::get<GeodeticPosition>(leap.position).altitude_m += 3;
  monitor.add(leap);
  EXPECT_TRUE(monitor.take_lidar_spoiled());
  EXPECT_FALSE(monitor.take_lidar_spoiled());
  EXPECT_EQ(monitor.report().state, HealthState::kFailed);
}

}  // namespace
}  // namespace alight
