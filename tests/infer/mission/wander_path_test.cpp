#include "infer/mission/wander_path.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(WanderPath, StaysInsideTheFenceAndMovesByTheWayFlown) {
  const WanderPath path(40, 7);
  Eigen::Vector2d before = path.at(0);
  EXPECT_NEAR(before.norm(), 0, 1e-9);
  constexpr double kStep_m = 0.05;
  for (double way_m = kStep_m; way_m < 5 * path.pass_m(); way_m += kStep_m) {
    const Eigen::Vector2d now = path.at(way_m);
    ASSERT_LE(now.norm(), 40 + 1e-9);
    ASSERT_LE((now - before).norm(), kStep_m * 1.0001) << "at " << way_m;
    before = now;
  }
}

TEST(WanderPath, TurnsOfAPassAreApartBySpacing) {
  const WanderPath path(40, 7);
  // r = spacing * turns: wherever the pass crosses the x axis it is a multiple of the spacing from the middle.
  Eigen::Vector2d before = path.at(1);
  int crossings = 0;
  for (double way_m = 1.0; way_m < path.pass_m(); way_m += 0.01) {
    const Eigen::Vector2d now = path.at(way_m);
    if (before.y() < 0 && now.y() >= 0) {
      ++crossings;
      EXPECT_NEAR(now.x(), 7.0 * crossings, 0.05);
    }
    before = now;
  }
  EXPECT_EQ(crossings, 5);
}

/// Two stretches of the path that are apart in way may cross, but never run along each other.
TEST(WanderPath, DoesNotRepeat) {
  const WanderPath path(40, 7);
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> headings;
  for (double way_m = 5; way_m < 4 * path.pass_m(); way_m += 0.5) {
    points.push_back(path.at(way_m));
    headings.push_back((path.at(way_m + 0.01) - path.at(way_m)).normalized());
  }
  int together = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 20; j < points.size(); ++j) {
      const bool near = (points[i] - points[j]).norm() < 0.25;
      const bool along = std::abs(headings[i].dot(headings[j])) > std::cos(0.02);
      together += near && along ? 1 : 0;
    }
  }
  // Points that coincide one by one would number thousands; where passes touch, a few do.
  EXPECT_LT(together, static_cast<int>(points.size() / 100));
}

TEST(WanderPath, CoversTheFence) {
  const WanderPath path(40, 7);
  std::vector<Eigen::Vector2d> points;
  for (double way_m = 0; way_m < path.pass_m(); way_m += 0.5) points.push_back(path.at(way_m));
  for (double y_m = -40; y_m <= 40; y_m += 1) {
    for (double x_m = -40; x_m <= 40; x_m += 1) {
      if (std::hypot(x_m, y_m) > 36.5) continue;
      double nearest_m = 1e9;
      for (const Eigen::Vector2d& p : points)
        nearest_m = std::min(nearest_m, (p - Eigen::Vector2d(x_m, y_m)).norm());
      ASSERT_LE(nearest_m, 3.6) << x_m << ", " << y_m;
    }
  }
}

TEST(WanderPath, RefusesAFenceOfNothing) { EXPECT_THROW(WanderPath(0, 7), std::invalid_argument); }

}  // namespace
}  // namespace alight
