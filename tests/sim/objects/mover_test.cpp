#include "sim/objects/mover.hpp"

#include <cmath>
#include <vector>

#include <opencv2/core.hpp>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/lidar_sensor.hpp"
#include "sim/sensors/livox_scan.hpp"
#include "sim/truth/surface_truth.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

constexpr float kBox_m = 1.0F;  // half a side; its top is 2 m high

/// Level ground and a box that sets out from x = -10 m at second 1 and goes to x = 10 m by 4 m/s.
World with_box(AtWaysEnd end = AtWaysEnd::kStay) {
  TriangleMesh ground;
  ground.add_quad({-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}, 0);
  TriangleMesh box;
  box.add_quad({-kBox_m, -kBox_m, 2}, {kBox_m, -kBox_m, 2}, {kBox_m, kBox_m, 2}, {-kBox_m, kBox_m, 2}, 1);
  Surface grass;
  Surface metal;
  metal.material = Material::kMetal;
  World world = World::from_meshes({ground}, {grass, metal}, 60);
  Mover mover(world.add(box), Eigen::Vector3f::Ones(), {-10, 0}, {10, 0}, {0, 0});
  mover.set_pace(1, 4, end);
  world.add(mover);
  return world;
}

TEST(Mover, FollowsItsWayAndTheGround) {
  Mover mover(0, Eigen::Vector3f::Ones(), {0, 0}, {0, 8}, {1, 2, 0});
  mover.set_pace(2, 2, AtWaysEnd::kStay);
  EXPECT_TRUE(mover.p_world(0).isApprox(Eigen::Vector3f(0, 0, 1)));
  EXPECT_TRUE(mover.p_world(3).isApprox(Eigen::Vector3f(0, 2, 1.5F)));
  EXPECT_TRUE(mover.p_world(5).isApprox(Eigen::Vector3f(0, 6, 1)));
  EXPECT_TRUE(mover.p_world(50).isApprox(Eigen::Vector3f(0, 8, 0)));
  EXPECT_TRUE((mover.R_world_mesh() * Eigen::Vector3f::UnitX()).isApprox(Eigen::Vector3f::UnitY(), 1e-5F));
  mover.set_pace(-1, 2, AtWaysEnd::kAnew);
  EXPECT_NEAR(mover.p_world(0).y(), 2, 1e-5);
  EXPECT_NEAR(mover.p_world(4).y(), 2, 1e-5);
  mover.set_pace(0, 2, AtWaysEnd::kBack);
  EXPECT_NEAR(mover.p_world(5).y(), 6, 1e-5);
  EXPECT_NEAR(mover.p_world(9).y(), 2, 1e-5);
  EXPECT_THROW(Mover(0, Eigen::Vector3f::Ones(), {1, 1}, {1, 1}, {0, 0}), std::invalid_argument);
}

TEST(MovingWorld, ARayMeetsTheBoxWhereItIsAtTheRaysTime) {
  const World world = with_box();
  const Renderer renderer(world);
  for (const double t_s : {0.0, 1.0, 2.3, 4.0, 9.0}) {
    const double middle_m = std::min(10.0, -10 + 4 * std::max(0.0, t_s - 1));
    for (const double off_m : {-1.1, -0.9, 0.0, 0.9, 1.1}) {
      const Hit hit = renderer.cast({middle_m + off_m, 0.3, 20}, {0, 0, -1}, t_s);
      ASSERT_TRUE(hit.hit);
      const bool on_box = std::abs(off_m) < kBox_m;
      EXPECT_NEAR(hit.range_m, on_box ? 18 : 20, 1e-4) << t_s << " " << off_m;
      EXPECT_EQ(hit.material, on_box ? Material::kMetal : Material::kGrass);
      EXPECT_NEAR(hit.normal.z(), 1, 1e-5);
    }
  }
  // From below the ground hides it, and a packet may hold rays of many times.
  EXPECT_NEAR(renderer.cast({-10, 0, -5}, {0, 0, 1}, 0).range_m, 5, 1e-4);
  std::vector<Hit> hits;
  const std::vector<Eigen::Vector3d> from(20, Eigen::Vector3d(0, 0, 20));
  std::vector<double> times_s;
  for (int i = 0; i < 20; ++i) times_s.push_back(0.5 * i);
  renderer.cast_many(from, std::vector<Eigen::Vector3d>(20, -Eigen::Vector3d::UnitZ()), hits, times_s);
  for (std::size_t i = 0; i < hits.size(); ++i)
    EXPECT_EQ(hits[i].material == Material::kMetal, std::abs(times_s[i] - 3.5) < 0.25) << times_s[i];
  times_s.pop_back();
  EXPECT_THROW(renderer.cast_many(from, from, hits, times_s), std::invalid_argument);
}

TEST(MovingWorld, EveryLidarPointMeetsItAtItsOwnTime) {
  const World world = with_box();
  const Renderer renderer(world);
  FlightStart start;
  start.p_world = {0, 0, 20};
  const Vehicle vehicle(FlightPath(start, {FlightPhase{10, 0, Eigen::Vector3d::Zero(), 0}}));
  Eigen::Isometry3d T_imu_lidar = Eigen::Isometry3d::Identity();
  T_imu_lidar.linear() = Eigen::AngleAxisd(to_radians(90.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
  LidarConfig config;
  config.range_noise_m = 0;
  config.packet_s = 1;  // the box goes on by 4 m within it
  const LidarSensor lidar(renderer, vehicle, T_imu_lidar, config, 1);
  const LidarScan scan = lidar.scan(3);
  int on_box = 0;
  for (std::size_t i = 0; i < scan.shots.size(); ++i) {
    const double t_s = to_seconds(scan.t_begin_ns + static_cast<std::int64_t>(i) * kLivoxShotPeriod_ns);
    const Eigen::Vector3d p = vehicle.T_world_imu(t_s) * T_imu_lidar * scan.shots[i].p_lidar.cast<double>();
    if (p.z() < 1) continue;
    ++on_box;
    EXPECT_LE(std::abs(p.x() - (-10 + 4 * (t_s - 1))), kBox_m + 1e-3) << t_s;
  }
  EXPECT_GT(on_box, 1000);
}

TEST(MovingWorld, TruthAndShadowAreOfTheirTime) {
  const World world = with_box();
  const Renderer renderer(world);
  EXPECT_NEAR(SurfaceTruth(renderer, {}, 1.0).elevation_m(-10, 0), 2, 1e-4);
  EXPECT_NEAR(SurfaceTruth(renderer, {}, 6.0).elevation_m(-10, 0), 0, 1e-4);
  EXPECT_FALSE(SurfaceTruth(renderer, {}, 6.0).is_safe(10, 0));
  // The sun stands at (0.36, 0.48, 0.8): the shadow of a top 2 m up falls 0.9 m west and 1.2 m south of it.
  const auto brightness = [&](double t_s) {
    const View view =
        renderer.render_camera(test::intrinsics(), test::camera_above(-10.9, -1.2, 10), true, t_s);
    const cv::Vec3b pixel = view.image.at<cv::Vec3b>(view.image.rows / 2, view.image.cols / 2);
    return pixel[0] + pixel[1] + pixel[2];
  };
  EXPECT_LT(brightness(0), 0.8 * brightness(6));
}

TEST(MovingWorld, WhatStandsStillLooksTheSameBesideIt) {
  WorldConfig config;
  config.look = Look::kVillage;
  config.seed = 3;
  config.size_m = 80;
  const World still(config);
  config.hard.names = {"traffic", "people"};
  const World moving(config);
  ASSERT_TRUE(still.movers().empty());
  ASSERT_GT(moving.movers().size(), 4U);
  ASSERT_EQ(still.placements().size(), moving.placements().size());
  const Renderer a(still);
  const Renderer b(moving);
  const auto image = [](const Renderer& renderer, double t_s) {
    return renderer.render_camera(test::intrinsics(), test::camera_above(0, 0, 60), true, t_s);
  };
  EXPECT_EQ(cv::norm(image(a, 0).image, image(a, 5).image, cv::NORM_INF), 0);
  const View before = image(b, 0);
  const View after = image(b, 5);
  EXPECT_GT(cv::countNonZero(before.depth_m != after.depth_m), 0);
  // Almost everything is as it is without them.
  EXPECT_GT(cv::countNonZero(before.depth_m == image(a, 0).depth_m),
            0.98 * static_cast<double>(before.depth_m.total()));
  for (const Mover& mover : moving.movers()) {
    for (const double t_s : {0.0, 7.0, 100.0}) {
      const Eigen::Vector3f p = mover.p_world(t_s);
      EXPECT_LT(p.head<2>().cwiseAbs().maxCoeff(), 41);
      EXPECT_NEAR(p.z(), moving.ground_height_m(p.x(), p.y()), 0.1);
    }
  }
}

TEST(MovingWorld, AVisitorComesWhenItIsTold) {
  WorldConfig config;
  config.seed = 3;
  config.size_m = 60;
  config.visitor.kind = VisitorKind::kPerson;
  config.visitor.from_x_m = 10;
  config.visitor.to_x_m = -2;
  config.visitor.begin_s = 5;
  config.visitor.speed_mps = 2;
  const World world(config);
  ASSERT_EQ(world.movers().size(), 1U);
  EXPECT_NEAR(world.movers().front().p_world(5).x(), 10, 1e-5);
  EXPECT_NEAR(world.movers().front().p_world(8).x(), 4, 1e-5);
  const Hit head = Renderer(world).cast({4, 0, 50}, {0, 0, -1}, 8);
  EXPECT_NEAR(50 - head.range_m - world.movers().front().p_world(8).z(), 1.75, 0.02);
  EXPECT_THROW(parse_config<WorldConfig>("{visitor: {kind: car}}", "x"), ConfigError);
}

}  // namespace
}  // namespace alight::sim
