#include "sensors/stream/point_time_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/messages/byte_reader.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMillisecond = 1'000'000;

/// Every millisecond a point, from `begin_ms` after the stamp on.
LidarPacket packet(std::int64_t stamp_ms, std::int64_t begin_ms, int points = 100) {
  LidarPacket out;
  out.t_ns = stamp_ms * kMillisecond;
  for (int i = 0; i < points; ++i) out.returns.push_back({(stamp_ms + begin_ms + i) * kMillisecond, {}, 0});
  return out;
}

PointTimeGuard used_to_tenths() {
  PointTimeGuard guard;
  for (int i = 0; i < 10; ++i) {
    LidarPacket good = packet(100 * i, 0);
    EXPECT_EQ(guard.clean(good), 0) << i;
  }
  return guard;
}

TEST(PointTimeGuard, PointsOfAPeriodBeforeOrAfterTheStampStay) {
  PointTimeGuard guard = used_to_tenths();
  LidarPacket before = packet(1000, -99);
  EXPECT_EQ(guard.clean(before), 0);
  LidarPacket with_jitter = packet(1108, -5);
  EXPECT_EQ(guard.clean(with_jitter), 0);
}

TEST(PointTimeGuard, ACounterThatWrappedLosesItsPointsAlone) {
  PointTimeGuard guard = used_to_tenths();
  LidarPacket wrapped = packet(1000, 0);
  for (int i = 0; i < 10; ++i) wrapped.returns[static_cast<std::size_t>(10 * i)].t_ns += 4'294'967'296;
  EXPECT_EQ(guard.clean(wrapped), 10);
  EXPECT_EQ(wrapped.returns.size(), 90u);
  for (const LidarReturn& point : wrapped.returns) EXPECT_LT(point.t_ns, 1100 * kMillisecond);
}

TEST(PointTimeGuard, AMessageOfWrongTimesIsRefusedWithItsCure) {
  PointTimeGuard guard = used_to_tenths();
  LidarPacket runaway = packet(1000, 100);
  const std::string said = testing::message_of<DecodeError>([&] { guard.clean(runaway); });
  EXPECT_THAT(said, HasSubstr("times"));
  EXPECT_THAT(said, HasSubstr("every 0.100 s"));
  EXPECT_THAT(said, HasSubstr("point_time_unit"));
}

TEST(PointTimeGuard, TwiceTheSameMessageAndPausesDoNotChangeThePeriod) {
  PointTimeGuard guard = used_to_tenths();
  for (int i = 0; i < 20; ++i) {
    LidarPacket twice = packet(900, 0);
    EXPECT_EQ(guard.clean(twice), 0);
  }
  LidarPacket after_a_pause = packet(60'000, 0);
  EXPECT_EQ(guard.clean(after_a_pause), 0);
  LidarPacket wrong = packet(60'100, 0);
  wrong.returns.front().t_ns += 300 * kMillisecond;
  EXPECT_EQ(guard.clean(wrong), 1);
}

TEST(PointTimeGuard, TheFirstMessageIsJudgedByTheSlowestLidar) {
  PointTimeGuard guard;
  LidarPacket first = packet(0, 0);
  first.returns.back().t_ns += 4'294'967'296;
  EXPECT_EQ(guard.clean(first), 1);
}

}  // namespace
}  // namespace alight
