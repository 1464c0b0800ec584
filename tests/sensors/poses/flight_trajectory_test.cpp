#include "sensors/poses/flight_trajectory.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

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
