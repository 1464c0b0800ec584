#include "sensors/stream/fix_guard.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kMetresOfADegree = 111'000;

/// North of 31 degrees by some metres.
PositionSample fix(double t_s, double north_m, double sigma_m = 0) {
  return {to_nanoseconds(t_s), GeodeticPosition{31 + north_m / kMetresOfADegree, 121.5, 20, sigma_m}};
}

std::vector<double> north_m(const std::vector<PositionSample>& samples) {
  std::vector<double> found;
  for (const PositionSample& sample : samples)
    found.push_back(
        std::round((std::get<GeodeticPosition>(sample.position).latitude_deg - 31) * kMetresOfADegree));
  return found;
}

using Norths = std::vector<double>;

TEST(FixGuard, TheFirstFixWaitsForTheSecondAndThenEveryOneCounts) {
  FixGuard guard;
  EXPECT_EQ(north_m(guard.add(fix(0, 0))), Norths{});
  EXPECT_EQ(north_m(guard.add(fix(0.1, 1))), (Norths{0, 1}));
  EXPECT_EQ(north_m(guard.add(fix(0.2, 2))), (Norths{2}));
  EXPECT_EQ(guard.left_out(), 0);
}

TEST(FixGuard, AFirstFixElsewhereIsNotTheOrigin) {
  FixGuard guard;
  EXPECT_EQ(north_m(guard.add(fix(0, 5000))), Norths{});
  EXPECT_EQ(north_m(guard.add(fix(0.1, 0))), Norths{});
  EXPECT_EQ(north_m(guard.add(fix(0.2, 1))), (Norths{0, 1}));
  EXPECT_EQ(guard.left_out(), 1);
}

TEST(FixGuard, LatitudeAndLongitudeZeroAreNoPlaceHoweverOftenTheyCome) {
  FixGuard guard;
  for (int i = 0; i < 20; ++i)
    EXPECT_TRUE(guard.add({to_nanoseconds(0.1 * i), GeodeticPosition{0, 0, 0}}).empty());
  guard.add(fix(2.0, 0));
  EXPECT_EQ(north_m(guard.add(fix(2.1, 1))), (Norths{0, 1}));
  EXPECT_TRUE(guard.add({to_nanoseconds(2.2), GeodeticPosition{0, 0, 0}}).empty()) << "in flight, too";
  EXPECT_EQ(north_m(guard.add(fix(2.3, 2))), (Norths{2}));
  EXPECT_EQ(guard.left_out(), 21);
}

TEST(FixGuard, ALeapIsLeftOutUntilTheFollowingFixesAgreeOnIt) {
  FixGuard guard;
  guard.add(fix(0, 0));
  guard.add(fix(0.1, 0));
  EXPECT_TRUE(guard.add(fix(0.2, 300)).empty()) << "300 m in 0.1 s";
  EXPECT_EQ(north_m(guard.add(fix(0.3, 0))), Norths{0}) << "it was a single one";
  EXPECT_EQ(guard.left_out(), 1);
  for (int i = 0; i < FixGuard::kAgreeing - 1; ++i)
    EXPECT_TRUE(guard.add(fix(0.4 + 0.1 * i, 300 + i)).empty());
  EXPECT_EQ(north_m(guard.add(fix(0.9, 305))), (Norths{300, 301, 302, 303, 305}));
  EXPECT_EQ(guard.left_out(), 1);
}

TEST(FixGuard, AReceiverThatKnowsNotWhereItIsSaysSo) {
  FixGuard guard;
  EXPECT_TRUE(guard.add(fix(0, 0, 500)).empty());
  EXPECT_TRUE(guard.add(fix(0.1, 0, 500)).empty());
  EXPECT_EQ(guard.left_out(), 2);
  guard.add(fix(0.2, 0, 3));
  EXPECT_EQ(guard.add(fix(0.3, 0, 3)).size(), 2u);
}

TEST(FixGuard, AfterAPauseTheVehicleMayBeElsewhere) {
  FixGuard guard;
  guard.add(fix(0, 0));
  guard.add(fix(0.1, 0));
  EXPECT_EQ(guard.add(fix(10.1, 500)).size(), 1u) << "50 m/s";
}

TEST(FixGuard, MetresOfAnOdometryAreNotJudged) {
  FixGuard guard;
  EXPECT_EQ(guard.add({0, Eigen::Vector3d(0, 0, 0)}).size(), 1u);
}

}  // namespace
}  // namespace alight
