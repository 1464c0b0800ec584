#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "geometry/geodesy.hpp"
#include "geometry/rig/rig.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/camera_noise.hpp"
#include "sim/sensors/lidar_sensor.hpp"
#include "sim/sensors/livox_scan.hpp"
#include "sim/sensors/pose_sensors.hpp"
#include "sim/sensors/stereo_camera.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {
namespace {

constexpr double kBoxTop_m = 3.0;

/// Level ground z = 0 of one material, and if wanted a box in the middle whose top is at kBoxTop_m.
World flat_world(Material material, bool with_box) {
  TriangleMesh mesh;
  mesh.add_quad({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}, 0);
  if (with_box) {
    constexpr auto kTop = static_cast<float>(kBoxTop_m);
    mesh.add_quad({-2, -2, kTop}, {2, -2, kTop}, {2, 2, kTop}, {-2, 2, kTop}, 0);
    mesh.add_quad({-2, -2, 0}, {2, -2, 0}, {2, -2, kTop}, {-2, -2, kTop}, 0);
    mesh.add_quad({2, -2, 0}, {2, 2, 0}, {2, 2, kTop}, {2, -2, kTop}, 0);
    mesh.add_quad({2, 2, 0}, {-2, 2, 0}, {-2, 2, kTop}, {2, 2, kTop}, 0);
    mesh.add_quad({-2, 2, 0}, {-2, -2, 0}, {-2, -2, kTop}, {-2, 2, kTop}, 0);
  }
  Surface surface;
  surface.material = material;
  return World::from_meshes({mesh}, {surface}, 100);
}

const RectifiedRig& paper_rig() {
  static const RectifiedRig rig =
      StereoRectifier(load_rig(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml")).rig();
  return rig;
}
Eigen::Isometry3d T_imu_lidar() { return paper_rig().T_camera_imu.inverse() * paper_rig().T_camera_lidar; }

Vehicle hovering(double height_m) {
  FlightStart start;
  start.p_world = {0.3, -0.2, height_m};
  return Vehicle(FlightPath(start, {FlightPhase{10, 0, Eigen::Vector3d::Zero(), 0}}));
}

/// 3 m/s while turning by 30 deg/s: the paper's hard case for points at their own time.
Vehicle turning(double height_m) {
  FlightStart start;
  start.p_world = {-1, -1, height_m};
  start.velocity_mps = {3, 0, 0};
  start.yaw_rate_radps = to_radians(30.0);
  return Vehicle(FlightPath(start, {FlightPhase{10, 0, start.velocity_mps, start.yaw_rate_radps}}));
}

SensorsConfig quiet() {
  SensorsConfig config;
  config.noise = Noise::kOff;
  return effective(config);
}

std::size_t returns(const LidarScan& scan) {
  return static_cast<std::size_t>(std::count_if(
      scan.shots.begin(), scan.shots.end(), [](const LidarShot& shot) { return shot.p_lidar.norm() > 0; }));
}

double standard_deviation(const std::vector<double>& values) {
  double mean = 0;
  double squares = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values)
    squares += (value - mean) * (value - mean) / static_cast<double>(values.size());
  return std::sqrt(squares);
}

TEST(LidarSensor, EveryPointIsMeasuredFromThePoseAtItsOwnTime) {
  const World world = flat_world(Material::kConcrete, false);
  const Renderer renderer(world);
  const Vehicle vehicle = turning(20);
  const LidarSensor lidar(renderer, vehicle, T_imu_lidar(), quiet().lidar, 5);
  const LidarScan scan = lidar.scan(3);
  ASSERT_EQ(scan.shots.size(), 10'000U);
  EXPECT_EQ(scan.t_begin_ns, 300'000'000);
  EXPECT_EQ(returns(scan), 10'000U);
  const Eigen::Isometry3d T_world_first = vehicle.T_world_imu(to_seconds(scan.t_begin_ns)) * T_imu_lidar();
  double own_time_m = 0;
  double first_pose_m = 0;
  const Eigen::Vector3d expected_sideways = Eigen::Vector3d::UnitX() * 0.3;
  for (std::size_t i = 0; i < scan.shots.size(); ++i) {
    const double t_s = to_seconds(scan.t_begin_ns + static_cast<std::int64_t>(i) * kLivoxShotPeriod_ns);
    const Eigen::Vector3d p_lidar = scan.shots[i].p_lidar.cast<double>();
    const Eigen::Vector3d p_world = vehicle.T_world_imu(t_s) * T_imu_lidar() * p_lidar;
    own_time_m = std::max(own_time_m, std::abs(p_world.z()));
    first_pose_m = std::max(first_pose_m, (T_world_first * p_lidar - p_world).norm());
  }
  EXPECT_LT(own_time_m, 1e-4);
  // 0.1 s at 3 m/s alone: with the first point's pose the last point would be this wrong.
  EXPECT_GT(first_pose_m, 0.8 * expected_sideways.norm());
}

TEST(LidarSensor, PointsLandOnTheTrueDepth) {
  const World world = flat_world(Material::kConcrete, true);
  const Renderer renderer(world);
  const Vehicle vehicle = turning(15);
  const RectifiedRig rig = paper_rig();
  const LidarSensor lidar(renderer, vehicle, T_imu_lidar(), quiet().lidar, 5);
  const StereoCamera camera(renderer, vehicle, rig, quiet().camera, 5);
  const std::int64_t frame = 7;
  const StereoExposure exposure = camera.expose_frame(frame, true);
  int compared = 0;
  int close = 0;
  int on_box = 0;
  for (const std::int64_t packet : {2, 3, 4}) {
    const LidarScan scan = lidar.scan(packet);
    for (std::size_t i = 0; i < scan.shots.size(); ++i) {
      const double t_s = to_seconds(scan.t_begin_ns + static_cast<std::int64_t>(i) * kLivoxShotPeriod_ns);
      const Eigen::Vector3d p_world =
          vehicle.T_world_imu(t_s) * T_imu_lidar() * scan.shots[i].p_lidar.cast<double>();
      const Eigen::Vector3d p_camera = exposure.T_world_camera.inverse() * p_world;
      const Eigen::Vector2d pixel = rig.intrinsics.project(p_camera);
      if (!rig.intrinsics.contains(pixel.x(), pixel.y())) continue;
      const float depth_m = exposure.depth_m.at<float>(static_cast<int>(std::lround(pixel.y())),
                                                       static_cast<int>(std::lround(pixel.x())));
      ++compared;
      close += std::abs(static_cast<double>(depth_m) - p_camera.z()) < 0.02 ? 1 : 0;
      on_box += p_world.z() > kBoxTop_m - 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 20'000);
  EXPECT_GT(on_box, 500);
  // What differs are pixels on the box's edges and points on its sides.
  EXPECT_GT(close, compared * 98 / 100);
}

TEST(LidarSensor, WaterAndTheSkyGiveNoReturn) {
  const World lake = flat_world(Material::kWater, false);
  const Renderer renderer(lake);
  const Vehicle vehicle = hovering(10);
  const LidarScan scan = LidarSensor(renderer, vehicle, T_imu_lidar(), LidarConfig(), 1).scan(0);
  EXPECT_EQ(returns(scan), 0U);
  for (const LidarShot& shot : scan.shots) EXPECT_EQ(shot.reflectivity, 0);

  const World ground = flat_world(Material::kConcrete, false);
  const Renderer ground_renderer(ground);
  const Eigen::Isometry3d T_imu_up(Eigen::AngleAxisd(to_radians(-90.0), Eigen::Vector3d::UnitY()));
  EXPECT_EQ(returns(LidarSensor(ground_renderer, vehicle, T_imu_up, LidarConfig(), 1).scan(0)), 0U);
}

TEST(LidarSensor, RangeLimitGoesWithTheRootOfReflectivity) {
  const World world = flat_world(Material::kConcrete, false);
  const Renderer renderer(world);
  const double reflectivity = static_cast<double>(renderer.cast({0, 0, 10}, {0, 0, -1}).reflectivity);
  const double limit_m = 260 * std::sqrt(reflectivity / 0.8);
  const Vehicle near = hovering(limit_m * 0.8);
  const Vehicle far = hovering(limit_m * 1.1);
  const Vehicle landed = hovering(0.5);
  EXPECT_EQ(returns(LidarSensor(renderer, near, T_imu_lidar(), quiet().lidar, 1).scan(0)), 10'000U);
  EXPECT_EQ(returns(LidarSensor(renderer, far, T_imu_lidar(), quiet().lidar, 1).scan(0)), 0U);
  EXPECT_EQ(returns(LidarSensor(renderer, landed, T_imu_lidar(), quiet().lidar, 1).scan(0)), 0U);
}

TEST(LidarSensor, DarkGroundLosesSomeReturns) {
  const World world = flat_world(Material::kConcrete, false);
  const Renderer renderer(world);
  const Vehicle vehicle = hovering(10);
  LidarConfig config;
  const auto reflectivity = static_cast<double>(renderer.cast({0, 0, 10}, {0, 0, -1}).reflectivity);
  config.dark_reflectivity = std::min(1.0, 2 * reflectivity);
  config.dark_loss = 0.5;
  const double lost = 0.5 * (1 - reflectivity / config.dark_reflectivity);
  const LidarScan scan = LidarSensor(renderer, vehicle, T_imu_lidar(), config, 1).scan(0);
  EXPECT_NEAR(static_cast<double>(returns(scan)) / 10'000, 1 - lost, 0.02);
}

TEST(LidarSensor, RangeNoiseHasTheConfiguredSpread) {
  const World world = flat_world(Material::kConcrete, false);
  const Renderer renderer(world);
  const Vehicle vehicle = hovering(20);
  const LidarScan noisy = LidarSensor(renderer, vehicle, T_imu_lidar(), LidarConfig(), 9).scan(2);
  const LidarScan exact = LidarSensor(renderer, vehicle, T_imu_lidar(), quiet().lidar, 9).scan(2);
  std::vector<double> errors_m;
  double sideways_m = 0;
  for (std::size_t i = 0; i < noisy.shots.size(); ++i) {
    if (noisy.shots[i].p_lidar.norm() <= 0) continue;
    const Eigen::Vector3f ray = exact.shots[i].p_lidar.normalized();
    const Eigen::Vector3f error = noisy.shots[i].p_lidar - exact.shots[i].p_lidar;
    errors_m.push_back(static_cast<double>(error.dot(ray)));
    sideways_m = std::max(sideways_m, static_cast<double>((error - ray * error.dot(ray)).norm()));
  }
  ASSERT_GT(errors_m.size(), 9'000U);
  EXPECT_NEAR(standard_deviation(errors_m), 0.02, 0.001);
  EXPECT_LT(sideways_m, 1e-4);
}

TEST(LidarSensor, AnotherSeedStartsElsewhereInThePattern) {
  const World world = flat_world(Material::kConcrete, false);
  const Renderer renderer(world);
  const Vehicle vehicle = hovering(20);
  const auto first = [&](std::uint64_t seed) {
    return LidarSensor(renderer, vehicle, T_imu_lidar(), quiet().lidar, seed).scan(0).shots.front().p_lidar;
  };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
}

TEST(CameraNoise, HasTheConfiguredVariance) {
  CameraConfig config;
  config.read_noise = 2.0;
  config.shot_noise = 0.05;
  cv::Mat image(400, 640, CV_8UC3, cv::Scalar::all(120));
  expose(image, config, 1.0, CounterRandom(3, RandomStream::kLeftImage));
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(mean[channel], 120.0, 0.05);
    // 1/12: rounding to whole grey levels
    EXPECT_NEAR(deviation[channel], std::sqrt(4.0 + 0.05 * 120 + 1.0 / 12), 0.03);
  }
}

TEST(CameraNoise, DependsOnFrameAndCameraAlone) {
  const CameraConfig config;
  const cv::Mat grey(20, 30, CV_8UC3, cv::Scalar::all(90));
  const auto exposed = [&](RandomStream camera, std::uint64_t frame) {
    cv::Mat image = grey.clone();
    expose(image, config, 1.0, CounterRandom(3, camera).child(frame));
    return image;
  };
  const cv::Mat image = exposed(RandomStream::kLeftImage, 4);
  EXPECT_EQ(cv::norm(image, exposed(RandomStream::kLeftImage, 4), cv::NORM_L1), 0);
  EXPECT_GT(cv::norm(image, exposed(RandomStream::kLeftImage, 5), cv::NORM_L1), 0);
  EXPECT_GT(cv::norm(image, exposed(RandomStream::kRightImage, 4), cv::NORM_L1), 0);
}

TEST(CameraNoise, OffLeavesTheImageAlone) {
  cv::Mat image(4, 4, CV_8UC3, cv::Scalar(3, 128, 255));
  const cv::Mat before = image.clone();
  const CameraConfig config = quiet().camera;
  expose(image, config, brightness(config, 3.0), CounterRandom(1, RandomStream::kLeftImage));
  EXPECT_EQ(cv::norm(image, before, cv::NORM_L1), 0);
}

TEST(StereoCamera, CamerasAreOneBaselineApart) {
  const World world = flat_world(Material::kPaving, false);
  const Renderer renderer(world);
  const Vehicle vehicle = hovering(8.8);  // camera 8.8 m - 0.12 m up: a disparity of 4 px
  RectifiedRig rig = paper_rig();
  const double depth_m =
      vehicle.T_world_imu(0).translation().z() + (rig.T_camera_imu.inverse().translation()).z();
  rig.baseline_m = 4.0 * depth_m / rig.intrinsics.fx_px;
  const StereoExposure exposure =
      StereoCamera(renderer, vehicle, rig, quiet().camera, 1).expose_frame(0, true);
  EXPECT_NEAR(exposure.depth_m.at<float>(200, 320), depth_m, 1e-3);
  cv::Mat difference;
  cv::absdiff(exposure.left.colRange(4, 640), exposure.right.colRange(0, 636), difference);
  cv::Mat unaligned;
  cv::absdiff(exposure.left, exposure.right, unaligned);
  EXPECT_LT(cv::mean(difference)[1], 0.3);
  EXPECT_GT(cv::mean(unaligned)[1], 4 * cv::mean(difference)[1]);
}

TEST(PoseSensors, HoverFeelsGravityAndNoRotation) {
  const Vehicle vehicle = hovering(30);
  const PoseSensors sensors(vehicle, quiet(), 1, 0);
  const ImuSample sample = sensors.imu(100);
  EXPECT_TRUE(sample.specific_force_mps2.isApprox(Eigen::Vector3d(0, 0, kGravity_mps2), 1e-12));
  EXPECT_LT(sample.angular_velocity_radps.norm(), 1e-9);
  EXPECT_NEAR(sensors.height_m(7), 30, 1e-9);
}

TEST(PoseSensors, FixesReadBackToTheTrueDisplacement) {
  const Vehicle vehicle = turning(25);
  const PoseSensors sensors(vehicle, quiet(), 1, -2);
  const GeodeticFix first = sensors.position(0);
  EXPECT_NEAR(first.altitude_m, GpsConfig().altitude_m + 27, 1e-6);
  const LocalEnu reader(first.latitude_deg, first.longitude_deg, first.altitude_m);
  const GeodeticFix later = sensors.position(400);  // 8 s
  const Eigen::Vector3d p = reader.to_world(later.latitude_deg, later.longitude_deg, later.altitude_m);
  EXPECT_TRUE(p.isApprox(Eigen::Vector3d(24, 0, 0), 1e-7)) << p.transpose();
}

TEST(PoseSensors, GyroscopeReadsTheTurn) {
  FlightStart start;
  start.yaw_rate_radps = to_radians(30.0);
  const Vehicle vehicle(
      FlightPath(start, {FlightPhase{10, 0, Eigen::Vector3d::Zero(), start.yaw_rate_radps}}));
  const ImuSample sample = PoseSensors(vehicle, quiet(), 1, 0).imu(200);
  EXPECT_LT((sample.angular_velocity_radps - Eigen::Vector3d(0, 0, to_radians(30.0))).norm(), 1e-7);
}

TEST(PoseSensors, ErrorsHaveTheConfiguredSpread) {
  const Vehicle vehicle = hovering(30);
  SensorsConfig config;
  config.imu.rate_hz = 1000;
  config.attitude.rate_hz = 1000;
  config.imu.accelerometer_bias_mps2 = 0;
  const PoseSensors sensors(vehicle, config, 4, 0);
  std::vector<double> force_mps2;
  std::vector<double> angle_rad;
  for (std::int64_t k = 0; k < 5000; ++k) {
    force_mps2.push_back(sensors.imu(k).specific_force_mps2.x());
    angle_rad.push_back(2 * sensors.attitude(k).y());
  }
  EXPECT_NEAR(standard_deviation(force_mps2), config.imu.accelerometer_noise_mps2, 0.002);
  EXPECT_NEAR(standard_deviation(angle_rad), to_radians(config.attitude.noise_deg), 1e-4);
}

TEST(PoseSensors, DriftIsSlowAndSettlesAtItsSpread) {
  FlightStart start;
  start.p_world = {0, 0, 20};
  const Vehicle vehicle(FlightPath(start, {FlightPhase{20'000, 0, Eigen::Vector3d::Zero(), 0}}));
  SensorsConfig config;
  config.gps.rate_hz = 1;
  config.gps.drift_time_s = 10;
  config.gps.noise_m = 0;
  const PoseSensors sensors(vehicle, config, 4, 0);
  std::vector<double> drift_m;
  std::vector<double> step_m;
  for (std::int64_t k = 0; k < 20'000; ++k) {
    drift_m.push_back(sensors.position(k).altitude_m);
    if (k > 0)
      step_m.push_back(drift_m[static_cast<std::size_t>(k)] - drift_m[static_cast<std::size_t>(k - 1)]);
  }
  EXPECT_NEAR(drift_m.front(), config.gps.altitude_m + 20, 1e-6);
  EXPECT_NEAR(standard_deviation(drift_m), 0.3, 0.03);
  EXPECT_NEAR(standard_deviation(step_m), 0.3 * std::sqrt(2 * (1 - std::exp(-0.1))), 0.005);
}

}  // namespace
}  // namespace alight::sim
