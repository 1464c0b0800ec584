#include "sensors/stream/attitude_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sensors/messages/byte_reader.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

AttitudeSample yawed(double t_s, double yaw_rad, std::optional<double> rate_rad_s = {}) {
  return {to_nanoseconds(t_s), Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
          rate_rad_s};
}

TEST(AttitudeGuard, AnOrientationThatStandsWhileItsGyroscopeTurnsIsRefused) {
  AttitudeGuard guard;
  for (int i = 0; i < 60; ++i) EXPECT_NO_THROW(guard.check(yawed(0.01 * i, 0, 0.5)));
  const std::string said = testing::message_of<DecodeError>([&] {
    for (int i = 60; i < 100; ++i) guard.check(yawed(0.01 * i, 0, 0.5));
  });
  EXPECT_THAT(said, HasSubstr("stands still"));
  EXPECT_THAT(said, HasSubstr("log.attitude_topic"));
}

TEST(AttitudeGuard, TurningHoveringAndRockingVehiclesPass) {
  AttitudeGuard turning;
  AttitudeGuard hovering;
  AttitudeGuard without_gyroscope;
  for (int i = 0; i < 3000; ++i) {
    const double t_s = 0.01 * i;
    EXPECT_NO_THROW(turning.check(yawed(t_s, 0.5 * t_s, 0.5)));
    EXPECT_NO_THROW(hovering.check(yawed(t_s, 0, 0.0)));
    EXPECT_NO_THROW(without_gyroscope.check(yawed(t_s, 0)));
  }
  AttitudeGuard rocking;  // back and forth: 0.1 rad at 1 Hz
  for (int i = 0; i < 3000; ++i) {
    const double t_s = 0.01 * i;
    EXPECT_NO_THROW(rocking.check(
        yawed(t_s, 0.1 * std::sin(2 * kPi * t_s), 0.1 * 2 * kPi * std::abs(std::cos(2 * kPi * t_s)))));
  }
}

TEST(AttitudeGuard, StampsInBurstsAreRefused) {
  AttitudeGuard guard;
  const std::string said = testing::message_of<DecodeError>([&] {
    for (int i = 0; i < 400; ++i) guard.check(yawed(0.105 * (i / 21) + 4e-6 * (i % 21), 0.001 * i));
  });
  EXPECT_THAT(said, HasSubstr("bursts"));
}

TEST(AttitudeGuard, AFewMillisecondsOfJitterPass) {
  AttitudeGuard pairs;  // two at a time, every 10 ms
  AttitudeGuard jitter;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_NO_THROW(pairs.check(yawed(0.01 * (i / 2) + 1e-5 * (i % 2), 0.001 * i)));
    EXPECT_NO_THROW(jitter.check(yawed(0.01 * i + 0.004 * ((i * 7) % 3 - 1), 0.001 * i)));
  }
}

}  // namespace
}  // namespace alight
