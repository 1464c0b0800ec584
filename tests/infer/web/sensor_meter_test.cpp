#include "infer/web/sensor_meter.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(SensorMeter, RateIsThatOfTheMessagesTimesWhateverTheBursts) {
  SensorMeter meter;
  const SteadyTime now = steady_now();
  for (int i = 0; i < 100; ++i) meter.add(i * 10 * kMillisecond, now);  // 100 Hz, all at once
  EXPECT_NEAR(meter.rate_hz(now), 100, 1e-9);
  EXPECT_EQ(meter.count(), 100);
}

TEST(SensorMeter, FollowsARateThatChangesWithinTwoSeconds) {
  SensorMeter meter;
  const SteadyTime now = steady_now();
  for (int i = 0; i < 100; ++i) meter.add(i * 10 * kMillisecond, now);
  for (int i = 1; i <= 20; ++i) meter.add(1000 * kMillisecond + i * 200 * kMillisecond, now);
  EXPECT_NEAR(meter.rate_hz(now), 5, 1e-9);
}

TEST(SensorMeter, SilenceIsNoRateAndAGrowingAge) {
  SensorMeter meter;
  EXPECT_FALSE(meter.age_s(steady_now()));
  EXPECT_EQ(meter.rate_hz(steady_now()), 0);
  const SteadyTime now = steady_now();
  meter.add(0, now);
  meter.add(50 * kMillisecond, now);
  EXPECT_NEAR(meter.rate_hz(now + std::chrono::seconds(1)), 20, 1e-9);
  EXPECT_NEAR(*meter.age_s(now + std::chrono::seconds(3)), 3, 1e-6);
  EXPECT_EQ(meter.rate_hz(now + std::chrono::seconds(3)), 0);
}

TEST(SensorMeter, AClockThatJumpsBackOrStandsStillHarmsNothing) {
  SensorMeter meter;
  const SteadyTime now = steady_now();
  meter.add(5000 * kMillisecond, now);
  meter.add(0, now);
  EXPECT_EQ(meter.rate_hz(now), 0);
  meter.add(100 * kMillisecond, now);
  EXPECT_NEAR(meter.rate_hz(now), 10, 1e-9);
  SensorMeter still;
  for (int i = 0; i < 10000; ++i) still.add(7, now);
  EXPECT_EQ(still.rate_hz(now), 0);
}

}  // namespace
}  // namespace alight
