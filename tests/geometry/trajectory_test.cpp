#include "geometry/trajectory.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

Eigen::Quaterniond yaw(double rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ()));
}

Trajectory two_streams() {
  Trajectory trajectory(0.1);
  for (int i = 0; i <= 20; ++i) trajectory.add_attitude(i * 10'000'000, yaw(0.02 * i));
  for (int i = 0; i <= 10; ++i) trajectory.add_position(i * 20'000'000 + 1'000'000, {0.06 * i, 0, 1});
  return trajectory;
}

TEST(Trajectory, LerpAndSlerpBetweenTheBracketingSamples) {
  const Trajectory trajectory = two_streams();
  const auto T = trajectory.T_world_imu(54'000'000);
  ASSERT_TRUE(T.has_value());
  EXPECT_NEAR(T->translation().x(), 0.06 * (54 - 1) / 20, 1e-12);
  const Eigen::AngleAxisd rotation(T->linear());
  EXPECT_NEAR(rotation.angle(), 0.02 * 5.4, 1e-12);
}

TEST(Trajectory, SlerpTurnsAtConstantRateAndTheShortWay) {
  Trajectory trajectory(1);
  trajectory.add_position(0, Eigen::Vector3d::Zero());
  trajectory.add_position(1000, Eigen::Vector3d::Zero());
  trajectory.add_attitude(0, yaw(0));
  Eigen::Quaterniond opposite_sign = yaw(1.2);
  opposite_sign.coeffs() *= -1;  // the same rotation
  trajectory.add_attitude(1000, opposite_sign);
  const auto T = trajectory.T_world_imu(250);
  EXPECT_NEAR(Eigen::AngleAxisd(T->linear()).angle(), 0.3, 1e-12);
}

TEST(Trajectory, NeverExtrapolates) {
  const Trajectory trajectory = two_streams();
  EXPECT_FALSE(trajectory.T_world_imu(999'999).has_value());  // positions begin at 1 ms
  EXPECT_TRUE(trajectory.T_world_imu(1'000'000).has_value());
  EXPECT_TRUE(trajectory.T_world_imu(200'000'000).has_value());
  EXPECT_FALSE(trajectory.T_world_imu(200'000'001).has_value());  // attitudes end at 200 ms
  EXPECT_EQ(trajectory.begin_ns(), 1'000'000);
  EXPECT_EQ(trajectory.end_ns(), 200'000'000);
  EXPECT_FALSE(Trajectory(1).end_ns().has_value());
}

TEST(Trajectory, DoesNotBridgeGaps) {
  Trajectory trajectory(0.1);
  for (const std::int64_t t_ms : {0, 50, 100, 201, 250}) {
    trajectory.add_attitude(t_ms * 1'000'000, yaw(0));
    trajectory.add_position(t_ms * 1'000'000, Eigen::Vector3d::Zero());
  }
  EXPECT_TRUE(trajectory.T_world_imu(99'000'000).has_value());
  EXPECT_FALSE(trajectory.T_world_imu(150'000'000).has_value());
  EXPECT_TRUE(trajectory.T_world_imu(201'000'000).has_value());  // on a sample nothing is bridged
  EXPECT_TRUE(trajectory.T_world_imu(240'000'000).has_value());
}

TEST(Trajectory, DropsWhatIsOutOfOrderOrNotANumber) {
  Trajectory trajectory(1);
  EXPECT_TRUE(trajectory.add_attitude(100, yaw(0)));
  EXPECT_FALSE(trajectory.add_attitude(100, yaw(1)));
  EXPECT_FALSE(trajectory.add_attitude(50, yaw(1)));
  EXPECT_FALSE(trajectory.add_attitude(200, Eigen::Quaterniond(0, 0, 0, 0)));
  EXPECT_FALSE(trajectory.add_attitude(200, Eigen::Quaterniond(std::nan(""), 0, 0, 0)));
  EXPECT_TRUE(trajectory.add_position(100, Eigen::Vector3d::Zero()));
  EXPECT_FALSE(trajectory.add_position(200, {std::nan(""), 0, 0}));
  EXPECT_FALSE(trajectory.add_position(90, Eigen::Vector3d::Zero()));
}

TEST(Trajectory, ForgettingKeepsWhatLaterTimesNeed) {
  Trajectory trajectory = two_streams();
  const auto before = trajectory.T_world_imu(120'000'000);
  trajectory.forget_before(120'000'000);
  EXPECT_FALSE(trajectory.T_world_imu(60'000'000).has_value());
  ASSERT_TRUE(trajectory.T_world_imu(120'000'000).has_value());
  EXPECT_TRUE(trajectory.T_world_imu(120'000'000)->isApprox(*before, 0));
}

}  // namespace
}  // namespace alight
