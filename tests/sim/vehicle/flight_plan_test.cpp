#include "sim/vehicle/flight_plan.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sim/render/renderer.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace alight::sim {
namespace {

/// 80 m of level concrete with a block of the given height around (x, y), 6 m wide.
World block_world(double x_m, double y_m, double height_m) {
  TriangleMesh mesh;
  mesh.add_quad({-300, -300, 0}, {300, -300, 0}, {300, 300, 0}, {-300, 300, 0}, 0);
  const auto x = static_cast<float>(x_m);
  const auto y = static_cast<float>(y_m);
  const auto z = static_cast<float>(height_m);
  mesh.add_quad({x - 3, y - 3, z}, {x + 3, y - 3, z}, {x + 3, y + 3, z}, {x - 3, y + 3, z}, 1);
  Surface ground;
  ground.material = Material::kConcrete;
  Surface roof;
  roof.material = Material::kRoofFlat;
  return World::from_meshes({mesh}, {ground, roof}, 80);
}

FlightPlanConfig calm() {
  FlightPlanConfig config;
  config.sway_m = 0;
  return config;
}

FlightPath landing_path(const FlightPlanConfig& config, std::uint64_t seed = 3) {
  return plan_flight(config, seed, 0, nullptr, "test");
}

TEST(FlightPath, VelocityAndAccelerationAreTheDerivatives) {
  FlightPlanConfig config;
  config.sway_m = 0.2;
  const FlightPath path = landing_path(config);
  constexpr double kStep_s = 1e-4;
  for (double t = 0.05; t < path.duration_s(); t += 0.173) {
    const PathPoint before = path.at(t - kStep_s);
    const PathPoint here = path.at(t);
    const PathPoint after = path.at(t + kStep_s);
    EXPECT_LT(((after.p_world - before.p_world) / (2 * kStep_s) - here.velocity_mps).norm(), 1e-6) << t;
    EXPECT_LT(((after.velocity_mps - before.velocity_mps) / (2 * kStep_s) - here.acceleration_mps2).norm(),
              1e-5)
        << t;
  }
}

TEST(FlightPath, IsSmoothThroughoutAndBeyondItsEnds) {
  const FlightPath path = landing_path(FlightPlanConfig());
  constexpr double kStep_s = 1e-3;
  PathPoint before = path.at(-0.5);
  for (double t = -0.5 + kStep_s; t < path.duration_s() + 0.5; t += kStep_s) {
    const PathPoint here = path.at(t);
    EXPECT_LT((here.p_world - before.p_world).norm(), 0.01);
    EXPECT_LT((here.velocity_mps - before.velocity_mps).norm(), 0.01);
    EXPECT_LT((here.acceleration_mps2 - before.acceleration_mps2).norm(), 0.05);
    EXPECT_LT(std::abs(here.yaw_rad - before.yaw_rad), 1e-3);
    before = here;
  }
}

TEST(FlightPlan, LandingGoesFromStartHeightToEndHeightAndStops) {
  const FlightPlanConfig config = calm();
  const FlightPath path = landing_path(config);
  EXPECT_DOUBLE_EQ(path.at(0).p_world.z(), 40);
  EXPECT_NEAR(path.at(config.hover_s).velocity_mps.norm(), 0, 1e-12);
  const PathPoint end = path.at(path.duration_s());
  EXPECT_NEAR(end.p_world.z(), 4, 1e-9);
  EXPECT_NEAR(end.velocity_mps.norm(), 0, 1e-12);
  double fastest_mps = 0;
  double sinking_mps = 0;
  double highest_turn = 0;
  for (double t = 0; t < path.duration_s(); t += 0.01) {
    const PathPoint point = path.at(t);
    fastest_mps = std::max(fastest_mps, point.velocity_mps.head<2>().norm());
    sinking_mps = std::max(sinking_mps, -point.velocity_mps.z());
    highest_turn = std::max(highest_turn, std::abs(path.at(t + 0.01).yaw_rad - point.yaw_rad) / 0.01);
  }
  EXPECT_NEAR(fastest_mps, config.speed_mps, 1e-3);
  EXPECT_NEAR(sinking_mps, config.descent_speed_mps, 1e-3);
  EXPECT_LE(highest_turn, to_radians(config.yaw_rate_deg_per_s) + 1e-6);
  EXPECT_GT(highest_turn, to_radians(config.yaw_rate_deg_per_s) / 10);
}

TEST(FlightPlan, SeedDecidesTheLegs) {
  const FlightPlanConfig config;
  const auto place = [&](std::uint64_t seed) { return landing_path(config, seed).at(9).p_world; };
  EXPECT_EQ(place(1), place(1));
  EXPECT_GT((place(1) - place(2)).norm(), 0.1);
}

TEST(FlightPlan, HoverStaysAndSwaysAsConfigured) {
  FlightPlanConfig config = calm();
  config.kind = PlanKind::kHover;
  const FlightPath still = landing_path(config);
  EXPECT_EQ(still.at(0).p_world, still.at(7.3).p_world);
  EXPECT_DOUBLE_EQ(still.duration_s(), config.duration_s);
  config.sway_m = 0.1;
  const FlightPath swaying = landing_path(config);
  double squares = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 10'000; ++i) mean += swaying.at(0.1 * i).p_world / 10'000;
  for (int i = 0; i < 10'000; ++i) squares += (swaying.at(0.1 * i).p_world - mean).squaredNorm() / 30'000;
  EXPECT_NEAR(std::sqrt(squares), 0.1, 0.005);
  EXPECT_EQ(swaying.at(0).p_world, still.at(0).p_world);
}

TEST(FlightPlan, StraightKeepsSpeedAndYawRate) {
  FlightPlanConfig config = calm();
  config.kind = PlanKind::kStraight;
  config.heading_deg = 0;
  config.yaw_rate_deg_per_s = 30;
  const FlightPath path = landing_path(config);
  EXPECT_LT((path.at(4).p_world - Eigen::Vector3d(12, 0, 40)).norm(), 1e-9);
  EXPECT_NEAR(path.at(4).yaw_rad, to_radians(120.0), 1e-9);
}

TEST(FlightPlan, DescendsOnSafeGroundBesideARoof) {
  FlightPlanConfig config = calm();
  const Eigen::Vector3d searched = landing_path(config).at(landing_path(config).duration_s()).p_world;
  const World world = block_world(searched.x(), searched.y(), 5);
  const Renderer renderer(world);
  const SurfaceTruth truth(renderer);
  const FlightPath path = plan_flight(config, 3, 0, &truth, "test");
  const Eigen::Vector3d end = path.at(path.duration_s()).p_world;
  EXPECT_GE(truth.clearance_m(end.x(), end.y()), config.site_radius_m);
  EXPECT_NEAR(end.z(), 4, 1e-3);
  EXPECT_GT((end - searched).head<2>().norm(), 3.0);
  EXPECT_LT((end - searched).head<2>().norm(), 9.0);
  EXPECT_NO_THROW(check_path(path, truth, 2.0, 5.0, "test"));
}

TEST(FlightPlan, RefusesWhatCannotBeFlown) {
  FlightPlanConfig config = calm();
  const FlightPath straight_down = landing_path(config);
  const Eigen::Vector3d searched = straight_down.at(straight_down.duration_s()).p_world;
  const World world = block_world(searched.x(), searched.y(), 5);
  const Renderer renderer(world);
  const SurfaceTruth truth(renderer);
  EXPECT_THAT([&] { check_path(straight_down, truth, 2.0, 5.0, "test"); },
              testing::ThrowsMessage<ConfigError>(testing::HasSubstr("above an obstacle")));
  config.approach_limit_m = 2;
  EXPECT_THAT([&] { plan_flight(config, 3, 0, &truth, "test"); },
              testing::ThrowsMessage<ConfigError>(testing::HasSubstr("no safe ground")));
  config = calm();
  config.kind = PlanKind::kStraight;
  config.duration_s = 60;
  EXPECT_THAT([&] { check_path(landing_path(config), truth, 2.0, 5.0, "test"); },
              testing::ThrowsMessage<ConfigError>(testing::HasSubstr("world")));
}

TEST(Vehicle, TiltFollowsTheAcceleration) {
  FlightStart start;
  start.yaw_rad = to_radians(90.0);  // nose to the north
  FlightPhase north;
  north.duration_s = 10;
  north.blend_s = 4;
  north.velocity_mps = {0, 3, 0};
  const Vehicle vehicle(FlightPath(start, {north}), 0.0);
  const VehicleState state = vehicle.state(2.0);
  const double acceleration = state.acceleration_mps2.y();
  EXPECT_NEAR(acceleration, 30.0 / 16 * 3 / 4, 1e-9);  // the smoothstep's steepest slope is 30/16
  const Eigen::Vector3d up_imu = state.T_world_imu.linear().transpose() * Eigen::Vector3d::UnitZ();
  // Nose down: in the body, up points backwards by atan(a / g), and not sideways.
  EXPECT_NEAR(std::atan2(-up_imu.x(), up_imu.z()), std::atan(acceleration / kGravity_mps2), 1e-12);
  EXPECT_NEAR(up_imu.y(), 0, 1e-12);
  // Thrust is the only force that an accelerometer feels where there is no drag: along the body's z.
  EXPECT_NEAR(state.specific_force_imu_mps2.head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR(state.specific_force_imu_mps2.z(), std::hypot(acceleration, kGravity_mps2), 1e-9);
}

TEST(Vehicle, AcceleratingToTheLeftRollsToTheLeft) {
  FlightPhase left;
  left.duration_s = 10;
  left.blend_s = 4;
  left.velocity_mps = {0, 3, 0};
  const Vehicle vehicle(FlightPath(FlightStart(), {left}), 0.0);  // nose to the east
  const Eigen::Vector3d up_imu = vehicle.T_world_imu(2.0).linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(up_imu.y(), -0.1);
  EXPECT_NEAR(up_imu.x(), 0, 1e-12);
}

TEST(Vehicle, DragLeansTheVehicleForwardAtConstantSpeed) {
  FlightStart start;
  start.velocity_mps = {5, 0, 0};
  const Vehicle vehicle(FlightPath(start, {FlightPhase{5, 0, {5, 0, 0}, 0}}), 0.15);
  const Eigen::Vector3d up_imu = vehicle.T_world_imu(2.0).linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(std::atan2(-up_imu.x(), up_imu.z()), std::atan(0.15 * 5 / kGravity_mps2), 1e-12);
}

TEST(Vehicle, BodyRatesIntegrateToTheAttitude) {
  FlightPlanConfig config;
  config.sway_m = 0.2;
  const Vehicle vehicle(landing_path(config));
  constexpr double kStep_s = 1e-3;
  Eigen::Quaterniond q(vehicle.T_world_imu(0).linear());
  for (int i = 0; i < 8000; ++i) {
    const Eigen::Vector3d turn = vehicle.state((i + 0.5) * kStep_s).angular_velocity_imu_radps * kStep_s;
    q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).normalized();
  }
  EXPECT_LT(q.angularDistance(Eigen::Quaterniond(vehicle.T_world_imu(8.0).linear())), 1e-5);
}

}  // namespace
}  // namespace alight::sim
