#include "infer/health/stream_watch.hpp"

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/infer/health/fault_names.hpp"

namespace alight {
namespace {

using test::fault_names;
using test::FaultNames;

std::int64_t at(double s) { return to_nanoseconds(s); }

TEST(MessageClock, OneStreamThatLeapsDoesNotMoveIt) {
  MessageClock clock;
  EXPECT_FALSE(clock.now_ns());
  clock.saw(Stream::kAttitude, at(1));
  EXPECT_EQ(clock.now_ns(), at(1));
  clock.saw(Stream::kPosition, at(1.01));
  clock.saw(Stream::kCamera, at(50));
  EXPECT_EQ(clock.now_ns(), at(1.01));
  clock.saw(Stream::kCamera, at(-50));
  EXPECT_EQ(clock.now_ns(), at(1));
}

TEST(StreamWatch, SilenceIsALossAndEndsWithTheNextMessage) {
  StreamWatch watch({}, Stream::kCamera, true);
  for (int i = 0; i < 10; ++i) watch.add(at(0.05 * i), at(0.05 * i), 0);
  watch.pass(at(0.74), 0);
  EXPECT_TRUE(watch.usable());
  watch.pass(at(0.76), 0);
  EXPECT_EQ(fault_names(watch), FaultNames{"left camera lost"});
  watch.add(at(0.8), at(0.8), 0);
  watch.pass(at(0.8), 0);
  EXPECT_TRUE(watch.usable());
}

TEST(StreamWatch, ASlowSensorMayBeSilentForLonger) {
  StreamWatch watch({}, Stream::kCamera, true);
  for (int i = 0; i < 10; ++i) watch.add(at(0.25 * i), at(0.25 * i), 0);
  watch.pass(at(2.25 + 0.6), 0);
  EXPECT_TRUE(watch.usable());
  watch.pass(at(2.25 + 0.65), 0);
  EXPECT_FALSE(watch.usable());
}

TEST(StreamWatch, ANeededSensorIsMissedFromTheStartAndAnotherIsNot) {
  StreamWatch needed({}, Stream::kLidar, true);
  StreamWatch other({}, Stream::kHeight, false);
  for (StreamWatch* watch : {&needed, &other}) watch->pass(at(1.1), 0);
  EXPECT_EQ(fault_names(needed), FaultNames{"lidar lost"});
  EXPECT_EQ(fault_names(other), FaultNames{});
}

TEST(StreamWatch, AWrongClockIsNotBelievedAndNamed) {
  for (const double off_s : {0.15, 5.0, -0.35, -5.0}) {
    StreamWatch watch({}, Stream::kLidar, true);
    EXPECT_TRUE(watch.add(at(9.9), at(9.9), 0));
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(watch.add(at(10 + 0.1 * i + off_s), at(10 + 0.1 * i), 0));
    watch.pass(at(10.5), 0);
    EXPECT_EQ(fault_names(watch), FaultNames{"lidar clock jump"}) << off_s;
  }
}

TEST(StreamWatch, MixedUpMessagesAreNamedAndOneIsForgiven) {
  StreamWatch once({}, Stream::kAttitude, true);
  StreamWatch often({}, Stream::kAttitude, true);
  for (int i = 1; i < 60; ++i) {
    once.add(at(0.01 * i), at(0.01 * i), 0);
    if (i == 30) once.add(at(0.28), at(0.3), 0);
    const double swapped_s = 0.01 * (i % 2 == 0 ? i - 1 : i + 1);
    often.add(at(swapped_s), at(0.01 * i), 0);
  }
  EXPECT_EQ(fault_names(once), FaultNames{});
  EXPECT_EQ(fault_names(often), FaultNames{"attitude out of order"});
}

}  // namespace
}  // namespace alight
