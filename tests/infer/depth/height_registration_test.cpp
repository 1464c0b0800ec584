#include "infer/depth/height_registration.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/infer/depth/engine_run.hpp"

namespace alight {
namespace {

using Ground = std::function<double(double x_m, double y_m)>;

/// 0.1 s of LiDAR around a place, heights `shift_m` too high and noisy.
WorldPacket packet_over(const Ground& ground, double x_m, double radius_m, double shift_m, int k,
                        unsigned seed) {
  std::mt19937 random(seed + static_cast<unsigned>(k));
  std::uniform_real_distribution<double> place(-radius_m, radius_m);
  std::normal_distribution<double> noise(0, 0.02);
  WorldPacket packet;
  packet.end_ns = to_nanoseconds(0.1 * (k + 1));
  for (int i = 0; i < 10000; ++i) {
    const double x = x_m + place(random);
    const double y = place(random);
    packet.points.push_back({packet.end_ns, {x, y, ground(x, y) + shift_m + noise(random)}});
  }
  return packet;
}

double level(double, double) { return 3; }

TEST(HeightRegistration, FindsTheStepsOfAReceiverOverLevelGround) {
  HeightRegistration registration;
  const std::vector<double> shifts_m = {0, 0.02, 0.07, 0.05, -0.03, -0.1, -0.12, 0.1};
  for (int k = 0; k < 8; ++k) {
    const double shift_m = shifts_m[static_cast<std::size_t>(k)];
    EXPECT_NEAR(registration.add(packet_over(level, 0, 4, shift_m, k, 1)), shift_m, 0.003) << k;
  }
}

TEST(HeightRegistration, SlopesAndStepsOfTheGroundAreNoneOfTheReceivers) {
  // 3 m/s over a slope of 10 degrees with a terrace every few metres, for three seconds.
  const Ground hill = [](double x, double) { return 0.176 * x + (std::fmod(x + 100, 4.0) < 2 ? 0.5 : 0.0); };
  HeightRegistration registration;
  double within_a_second_m = 0;
  std::vector<double> found_m;
  for (int k = 0; k < 30; ++k) {
    found_m.push_back(registration.add(packet_over(hill, 0.3 * k, 4, 0, k, 5)));
    const std::size_t first = k >= 10 ? static_cast<std::size_t>(k - 10) : 0;
    within_a_second_m = std::max(within_a_second_m, std::abs(found_m.back() - found_m[first]));
  }
  EXPECT_LT(within_a_second_m, 0.02);
}

TEST(HeightRegistration, FromLowASmallSpotIsEnough) {
  HeightRegistration registration;
  registration.add(packet_over(level, 0, 0.7, 0, 0, 3));
  EXPECT_NEAR(registration.add(packet_over(level, 0, 0.7, 0.05, 1, 3)), 0.05, 0.003);
}

TEST(HeightRegistration, WithoutCommonGroundTheShiftStays) {
  HeightRegistration registration;
  registration.add(packet_over(level, 0, 4, 0, 0, 1));
  registration.add(packet_over(level, 0, 4, 0.05, 1, 1));
  EXPECT_NEAR(registration.add(packet_over(level, 100, 4, 0.2, 2, 1)), 0.05, 0.003);
  registration.forget();
  EXPECT_NEAR(registration.add(packet_over(level, 100, 4, 0.4, 3, 1)), 0.05, 0.003);
}

TEST(HeightRegistration, ALeapIsNoDrift) {
  HeightRegistration registration;
  registration.add(packet_over(level, 0, 4, 0, 0, 1));
  EXPECT_NEAR(registration.add(packet_over(level, 0, 4, 0.8, 1, 1)), 0, 0.003);
  EXPECT_NEAR(registration.add(packet_over(level, 0, 4, 0.83, 2, 1)), 0.03, 0.003);
}

/// Standard deviation of the depth over level ground, by LiDAR alone, where the receiver's height wanders by 5 cm (1
/// sigma) in a second; mean over the images.
double depth_deviation_m(bool register_heights) {
  fakes::LevelWorld world(engine_run::kHeight_m);
  std::vector<LogMessage> messages = fakes::flight(world, {3.0});
  std::mt19937 random(7);
  std::normal_distribution<double> step_m(0, 0.05 * std::sqrt(0.02));
  double wander_m = 0;
  for (LogMessage& message : messages) {
    auto* sample = std::get_if<PositionSample>(&message);
    if (sample == nullptr) continue;
    wander_m += step_m(random);
    std::get<GeodeticPosition>(sample->position).altitude_m += wander_m;
  }
  DepthEngineConfig config = engine_run::config_of(false);
  config.register_heights = register_heights;
  double sum_m = 0;
  int images = 0;
  for (const DepthResult& result : engine_run::run(config, messages, nullptr).results) {
    if (result.accumulation_s < 0.9) continue;
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(result.depth_m, mean, deviation, result.depth_m > 0);
    // By so much it wanders between the nearest packet and the image.
    if (register_heights) EXPECT_NEAR(mean[0], engine_run::kHeight_m, 0.06);
    sum_m += deviation[0];
    ++images;
  }
  EXPECT_GT(images, 20);
  return sum_m / images;
}

TEST(HeightRegistration, MakesADepthMapOfAWanderingReceiverSmooth) {
  const double with_m = depth_deviation_m(true);
  EXPECT_LT(with_m, 0.008);
  EXPECT_GT(depth_deviation_m(false), 2 * with_m);
}

}  // namespace
}  // namespace alight
