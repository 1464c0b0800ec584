#include "infer/health/pose_watch.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/infer/health/fault_names.hpp"

namespace alight {
namespace {

using test::fault_names;
using test::FaultNames;

constexpr double kMetresOfADegree = 111'320;  // of latitude

PositionSample position(double t_s, double north_m) {
  return {to_nanoseconds(t_s), GeodeticPosition{north_m / kMetresOfADegree, 114.2, 50}};
}

AttitudeSample attitude(double t_s, double yaw_deg) {
  return {to_nanoseconds(t_s),
          Eigen::Quaterniond(Eigen::AngleAxisd(to_radians(yaw_deg), Eigen::Vector3d::UnitZ()))};
}

TEST(PoseWatch, AFastTurningVehicleIsHealthy) {
  PoseWatch watch({});
  for (int i = 0; i < 300; ++i) {
    const double t_s = 0.01 * i;
    EXPECT_FALSE(watch.add(attitude(t_s, 120 * t_s)));
    if (i % 2 == 0) {
      EXPECT_FALSE(watch.add(position(t_s, 15 * t_s + 0.5 * 8 * std::sin(t_s))));
    }
  }
  EXPECT_EQ(fault_names(watch), FaultNames{});
}

TEST(PoseWatch, ALeapOfAMetreIsNamedForASecond) {
  PoseWatch watch({});
  for (int i = 0; i < 100; ++i) watch.add(position(0.02 * i, 3 * 0.02 * i));
  EXPECT_TRUE(watch.add(position(2.0, 6.0 + 1.0)));
  EXPECT_EQ(fault_names(watch), FaultNames{"position jump"});
  EXPECT_FALSE(watch.usable());
  for (int i = 101; i < 160; ++i) EXPECT_FALSE(watch.add(position(0.02 * i, 3 * 0.02 * i + 1.0))) << i;
  EXPECT_EQ(fault_names(watch), FaultNames{});
}

TEST(PoseWatch, ATurnInNoTimeIsNamed) {
  PoseWatch watch({});
  for (int i = 0; i < 100; ++i) watch.add(attitude(0.01 * i, 0));
  EXPECT_TRUE(watch.add(attitude(1.0, 10)));
  EXPECT_EQ(fault_names(watch), FaultNames{"attitude jump"});
}

TEST(PoseWatch, ValuesThatStopVaryingAreFrozenAndOnesThatNeverDidAreNot) {
  PoseWatch varied({});
  PoseWatch constant({});
  for (int i = 0; i < 200; ++i) {
    const double t_s = 0.01 * i;
    varied.add(attitude(t_s, std::min(t_s, 1.0)));
    varied.add(position(t_s, std::min(t_s, 1.0)));
    constant.add(attitude(t_s, 0));
    constant.add(position(t_s, 0));
  }
  EXPECT_EQ(fault_names(varied), (FaultNames{"attitude frozen", "position frozen"}));
  EXPECT_EQ(fault_names(constant), FaultNames{});
}

}  // namespace
}  // namespace alight
