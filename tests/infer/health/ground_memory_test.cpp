#include "infer/health/ground_memory.hpp"

#include <random>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

/// Echoes of level ground at `height_m`, on 20 m x 20 m.
std::vector<Eigen::Vector3d> ground(double height_m, double noise_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-10, 10);
  std::normal_distribution<double> noise(0, noise_m);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(place(random), place(random), height_m + (noise_m > 0 ? noise(random) : 0.0));
  return points;
}

TEST(GroundMemory, TheSameGroundFitsToItsNoise) {
  GroundMemory memory({});
  memory.add(0, ground(2, 0.02, 1));
  const GroundFit fit = memory.fit(ground(2, 0.02, 2));
  EXPECT_GT(fit.cells, 1400);  // of 1600; the others got too few echoes
  EXPECT_LT(fit.misfit_m, 0.03);
  EXPECT_GT(fit.misfit_m, 0.01);
}

TEST(GroundMemory, OtherHeightsAreMeasuredUpToAMetre) {
  GroundMemory memory({});
  memory.add(0, ground(2, 0, 1));
  EXPECT_NEAR(memory.fit(ground(2.4, 0, 2)).misfit_m, 0.4, 1e-9);
  EXPECT_NEAR(memory.fit(ground(9, 0, 2)).misfit_m, 1.0, 1e-9);
}

TEST(GroundMemory, RoughCellsSayNothing) {
  GroundMemory memory({});
  memory.add(0, ground(2, 1.0, 1));
  EXPECT_EQ(memory.fit(ground(2, 0.02, 2)).cells, 0);
}

TEST(GroundMemory, ForgetsWhatIsOlderThanItsMemory) {
  GroundMemory memory({});
  memory.add(0, ground(2, 0, 1));
  memory.add(to_nanoseconds(1.1), {});
  EXPECT_EQ(memory.fit(ground(2, 0, 2)).cells, 0);
}

}  // namespace
}  // namespace alight
