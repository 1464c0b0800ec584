#include "sensors/messages/point_times.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sensors/test_flight.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

constexpr ScanStamp kStamp{1'700'000'000'000'000'000, 1'700'000'000'000'000'000, true};

std::vector<std::int64_t> offsets_ns(const std::vector<double>& values, TimeNumber number,
                                     const PointTiming& timing = {}, PointTimeMemory* memory = nullptr) {
  std::vector<std::int64_t> times = times_of_values(values, number, timing, kStamp, memory);
  for (std::int64_t& time : times) {
    if (time != kNoTime_ns) time -= kStamp.chosen_ns;
  }
  return times;
}

TEST(PointTimes, AShortCloudIsReadInTheUnitOfTheLongOnes) {
  PointTimeMemory memory;
  EXPECT_EQ(offsets_ns({0, 99'900'000}, TimeNumber::kWhole, {}, &memory).back(), 99'900'000);
  EXPECT_EQ(offsets_ns({0, 900'000}, TimeNumber::kWhole, {}, &memory).back(), 900'000)
      << "ns, not 0.9 s of us";
  PointTimeMemory seconds;
  offsets_ns({0, 0.0999}, TimeNumber::kSingle, {}, &seconds);
  EXPECT_EQ(offsets_ns({0, 0.0009}, TimeNumber::kSingle, {}, &seconds).back(), 900'000);
}

TEST(PointTimes, Float32CannotHoldAbsoluteSeconds) {
  const std::string said =
      testing::message_of<DecodeError>([] { offsets_ns({1.7e9, 1.7e9}, TimeNumber::kSingle); });
  EXPECT_THAT(said, HasSubstr("float32 cannot hold"));
  EXPECT_THAT(said, HasSubstr("point_time: none"));
  EXPECT_EQ(offsets_ns({1.7e9, 1.7e9 + 0.5}, TimeNumber::kDouble).back(), 500'000'000);
}

TEST(PointTimes, NegativeTimesCountBackFromTheStampWhateverEndItIs) {
  PointTiming at_end;
  at_end.stamp_at = PointTiming::StampAt::kEnd;
  PointTiming with_period = at_end;
  with_period.scan_period_s = 0.1;
  for (const PointTiming& timing : {PointTiming{}, at_end, with_period}) {
    const auto offsets = offsets_ns({-0.1, 0}, TimeNumber::kSingle, timing);
    EXPECT_NEAR(static_cast<double>(offsets.front()), -1e8, 1e4);
    EXPECT_EQ(offsets.back(), 0);
  }
}

TEST(PointTimes, ValuesThatAreNotFiniteTakeNoPart) {
  const auto offsets = offsets_ns({std::nan(""), 0, 0.1}, TimeNumber::kDouble);
  EXPECT_EQ(offsets, (std::vector<std::int64_t>{kNoTime_ns, 0, 100'000'000}));
}

}  // namespace
}  // namespace alight
