#include "sim/vehicle/multirotor.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

MultirotorConfig still_air() {
  MultirotorConfig config;
  config.wind_mps = 0;
  config.gust_mps = 0;
  config.drag_per_s = 0;
  return config;
}

Multirotor vehicle(const MultirotorConfig& config, std::uint64_t seed = 1) {
  return {config, {1, 2, 30}, 0.4, seed, 60};
}

TEST(Multirotor, FollowsAVelocityWithItsLag) {
  MultirotorConfig config = still_air();
  config.max_acceleration_mps2 = 30;
  config.max_jerk_mps3 = 1000;
  Multirotor v = vehicle(config);
  v.command({{1, 0, 0}, 0});
  v.advance_to(5);
  // First order: 1 - exp(-t / lag).
  for (const double t_s : {0.25, 0.5, 1.0, 2.0}) {
    EXPECT_NEAR(v.state(t_s).velocity_mps.x(), 1 - std::exp(-t_s / config.velocity_lag_s), 0.02) << t_s;
  }
  EXPECT_NEAR(v.state(4.5).T_world_imu.translation().x(), 1 + 4.5 - config.velocity_lag_s, 0.02);
}

TEST(Multirotor, KeepsItsLimits) {
  const MultirotorConfig config = still_air();
  Multirotor v = vehicle(config);
  v.command({{50, -50, -50}, 0});
  v.advance_to(20);
  for (double t_s = 0; t_s < 19; t_s += 0.05) {
    const VehicleState state = v.state(t_s);
    EXPECT_LE(state.velocity_mps.head<2>().norm(), config.max_speed_mps + 1e-6);
    EXPECT_GE(state.velocity_mps.z(), -config.max_descent_mps - 1e-6);
    EXPECT_LE(state.acceleration_mps2.norm(), config.max_acceleration_mps2 + 1e-6);
  }
  EXPECT_NEAR(v.state(19).velocity_mps.z(), -config.max_descent_mps, 1e-3);
  Multirotor turning = vehicle(config);
  turning.command({{0, 0, 0}, 9});
  turning.advance_to(10);
  EXPECT_NEAR(turning.state(9).angular_velocity_imu_radps.z(), to_radians(config.max_yaw_rate_deg_per_s),
              1e-3);
}

/// The health monitor takes a turn of 6 degrees in 20 ms for a broken sensor.
TEST(Multirotor, NeverTurnsLikeABrokenSensor) {
  MultirotorConfig config;
  config.gust_mps = 2;
  Multirotor v = vehicle(config, 5);
  for (int i = 0; i < 40; ++i) {
    v.command({{i % 2 == 0 ? 8.0 : -8.0, 0, i % 3 == 0 ? 4.0 : -3.0}, i % 2 == 0 ? 2.0 : -2.0});
    v.advance_to(0.5 * i);
  }
  for (double t_s = 0; t_s < 19; t_s += 0.02) {
    const Eigen::Quaterniond a(v.T_world_imu(t_s).linear());
    const Eigen::Quaterniond b(v.T_world_imu(t_s + 0.02).linear());
    ASSERT_LT(to_degrees(a.angularDistance(b)), 4.0) << t_s;
  }
}

TEST(Multirotor, LeansIntoTheWindAndStays) {
  MultirotorConfig config;
  config.wind_mps = 8;
  config.gust_mps = 0;
  Multirotor v = vehicle(config, 3);
  ASSERT_GT(v.mean_wind_mps().norm(), 1);
  v.advance_to(10);
  EXPECT_NEAR((v.p_world() - Eigen::Vector3d(1, 2, 30)).norm(), 0, 0.05);
  const Eigen::Vector3d up = v.T_world_imu(9).linear().col(2);
  EXPECT_NEAR(std::tan(std::acos(up.z())), config.drag_per_s * v.mean_wind_mps().norm() / kGravity_mps2,
              1e-3);
  EXPECT_LT(up.head<2>().dot(v.mean_wind_mps().head<2>()), 0);
}

TEST(Multirotor, PositionAndVelocityBelongTogether) {
  Multirotor v = vehicle({}, 9);
  v.command({{3, 1, -1}, 0.5});
  v.advance_to(6);
  for (double t_s = 0.1; t_s < 5.5; t_s += 0.0137) {
    const Eigen::Vector3d by_position =
        (v.T_world_imu(t_s + 1e-4).translation() - v.T_world_imu(t_s - 1e-4).translation()) / 2e-4;
    ASSERT_LT((by_position - v.state(t_s).velocity_mps).norm(), 0.02) << t_s;
  }
}

TEST(Multirotor, SeedDecidesTheWindAndNothingElseDoes) {
  Multirotor a = vehicle({}, 4);
  Multirotor b = vehicle({}, 4);
  Multirotor c = vehicle({}, 5);
  a.advance_to(5);
  for (double t_s = 0.1; t_s < 5.1; t_s += 0.1) b.advance_to(t_s);
  c.advance_to(5);
  EXPECT_EQ(a.T_world_imu(4.2).matrix(), b.T_world_imu(4.2).matrix());
  EXPECT_NE(a.T_world_imu(4.2).matrix(), c.T_world_imu(4.2).matrix());
}

TEST(Multirotor, KnowsNothingOfTheFutureAndStandsWhenStopped) {
  Multirotor v = vehicle({});
  v.advance_to(1);
  EXPECT_THROW(v.T_world_imu(1.1), std::logic_error);
  v.stop();
  const Eigen::Vector3d p = v.p_world();
  v.command({{5, 0, 0}, 0});
  v.advance_to(3);
  EXPECT_EQ(v.p_world(), p);
}

}  // namespace
}  // namespace alight::sim
