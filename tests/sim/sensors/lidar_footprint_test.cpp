#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sim/sensors/lidar_sensor.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace alight::sim {
namespace {

constexpr double kHeight_m = 5;

/// The LiDAR looks straight down: boresight -z, its up = world y, its left = -x.
Eigen::Isometry3d T_imu_boresight() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  return T;
}

Vehicle hovering_low() {
  FlightStart start;
  start.p_world = {0, 0, kHeight_m};
  return Vehicle(FlightPath(start, {FlightPhase{10, 0, Eigen::Vector3d::Zero(), 0}}), 0);
}

/// Level ground, white on the one side of a line through the middle and black on the other, one may lie higher.
/// @param along_x whether the line runs along x (crossed going up, y) or along y
World half_and_half(bool along_x, float black_height_m) {
  TriangleMesh mesh;
  const auto half = [&](float from, float to, float z, std::uint16_t surface) {
    if (along_x) {
      mesh.add_quad({-50, from, z}, {50, from, z}, {50, to, z}, {-50, to, z}, surface);
    } else {
      mesh.add_quad({from, -50, z}, {to, -50, z}, {to, 50, z}, {from, 50, z}, surface);
    }
  };
  half(-50, 0, 0, 0);
  half(0, 50, black_height_m, 1);
  std::vector<Surface> surfaces(2);
  surfaces[0].material = Material::kBoardWhite;
  surfaces[1].material = Material::kBoardBlack;
  return World::from_meshes({mesh}, surfaces, 100);
}

LidarConfig beam(double up_deg, double across_deg) {
  LidarConfig config;
  config.range_noise_m = config.dark_loss = 0;
  config.divergence_up_deg = up_deg;
  config.divergence_across_deg = across_deg;
  return config;
}

struct Crossing {
  double distance_deg;  // of the beam's middle from the line, positive on black
  double level;
  double range_m;
};

/// Every shot of half a second near the line.
std::vector<Crossing> crossings(const LidarConfig& config, bool along_x, float black_height_m = 0) {
  const World world = half_and_half(along_x, black_height_m);
  const Renderer renderer(world);
  const Vehicle vehicle = hovering_low();
  const LidarSensor lidar(renderer, vehicle, T_imu_boresight(), config, 4);
  std::vector<Crossing> result;
  for (std::int64_t packet = 0; packet < 5; ++packet) {
    for (const LidarShot& shot : lidar.scan(packet).shots) {
      if (shot.p_lidar.norm() == 0) continue;
      const Eigen::Vector3d direction = shot.p_lidar.cast<double>().normalized();
      // The line crosses near the boresight alone, where up and across are the ground's axes.
      if (direction.x() < std::cos(to_radians(3.0))) continue;
      const double off = along_x ? direction.z() : -direction.y();
      result.push_back(
          {to_degrees(std::asin(off)), static_cast<double>(shot.reflectivity), shot.p_lidar.norm()});
    }
  }
  return result;
}

double mean_level(const std::vector<Crossing>& all, double from_deg, double to_deg) {
  double sum = 0;
  int count = 0;
  for (const Crossing& c : all) {
    if (c.distance_deg < from_deg || c.distance_deg > to_deg) continue;
    sum += c.level;
    ++count;
  }
  EXPECT_GT(count, 5) << from_deg;
  return sum / count;
}

class Footprint : public ::testing::TestWithParam<bool> {};

TEST_P(Footprint, BlursAnEdgeOverItsOwnWidthAndNoFarther) {
  constexpr double kUp_deg = 0.28;
  constexpr double kAcross_deg = 0.08;
  const bool along_x = GetParam();
  const double half_deg = 0.5 * (along_x ? kUp_deg : kAcross_deg);
  const std::vector<Crossing> blurred = crossings(beam(kUp_deg, kAcross_deg), along_x);
  const double white = mean_level(blurred, -2, -half_deg - 0.01);
  const double black = mean_level(blurred, half_deg + 0.01, 2);
  ASSERT_GT(white, black + 50);
  for (const Crossing& c : blurred) {
    if (std::abs(c.distance_deg) <= half_deg + 0.01) continue;
    EXPECT_NEAR(c.level, c.distance_deg < 0 ? white : black, 1.0) << c.distance_deg;
  }
  // In between, the share of the beam on either side: linear across a rectangular footprint.
  EXPECT_NEAR(mean_level(blurred, -0.1 * half_deg, 0.1 * half_deg), 0.5 * (white + black),
              0.12 * (white - black));
  EXPECT_NEAR(mean_level(blurred, -0.6 * half_deg, -0.4 * half_deg), 0.75 * white + 0.25 * black,
              0.12 * (white - black));
  EXPECT_NEAR(mean_level(blurred, 0.4 * half_deg, 0.6 * half_deg), 0.25 * white + 0.75 * black,
              0.12 * (white - black));
}
INSTANTIATE_TEST_SUITE_P(UpAndAcross, Footprint, ::testing::Bool());

TEST(Footprint, APencilBeamIsBlackOrWhite) {
  for (const Crossing& c : crossings(beam(0, 0), true)) {
    const bool white = c.level > 60;
    EXPECT_EQ(white, c.distance_deg < 0) << c.distance_deg;
  }
}

TEST(Footprint, OfTwoSurfacesTheStrongerEchoGivesTheRange) {
  constexpr float kStep_m = 2;  // black is nearer, but white throws back more
  int between = 0;
  for (const Crossing& c : crossings(beam(0.28, 0.03), true, kStep_m)) {
    const double ground_m = kHeight_m;
    const double top_m = kHeight_m - static_cast<double>(kStep_m);
    const bool on_ground = std::abs(c.range_m - ground_m) < 0.05;
    const bool on_top = std::abs(c.range_m - top_m) < 0.05;
    between += on_ground || on_top ? 0 : 1;
  }
  EXPECT_EQ(between, 0);  // two echoes far apart never mix
}

}  // namespace
}  // namespace alight::sim
