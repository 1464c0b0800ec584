#include "calibrate/clocks/depth_edges.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

/// A sweep across a wall's rim: beams `step_deg` apart about z, near ones end at `near_m`, those from `rim` on at `far_m`.
std::vector<LidarReturn> sweep(double step_deg, int rim, double near_m, double far_m) {
  std::vector<LidarReturn> returns;
  for (int i = 0; i < 10; ++i) {
    const double angle = to_radians(i * step_deg);
    const double range_m = i < rim ? near_m : far_m;
    LidarReturn point;
    point.t_ns = 10'000 * i;
    point.p_lidar = (range_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).cast<float>();
    returns.push_back(point);
  }
  return returns;
}

TEST(DepthEdges, LieHalfWayBetweenTheBeamsAtTheNearerRange) {
  const std::vector<LidarReturn> edges = depth_edges(sweep(0.2, 4, 10, 15), {});
  ASSERT_EQ(edges.size(), 1u);
  const Eigen::Vector3f& p = edges[0].p_lidar;
  EXPECT_NEAR(p.norm(), 10, 1e-4);
  EXPECT_NEAR(to_degrees(std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x()))), 0.7, 1e-3);
  EXPECT_EQ(edges[0].t_ns, 30'000);  // of the nearer return
}

TEST(DepthEdges, DoNotDependOnTheDirectionOfTheSweep) {
  std::vector<LidarReturn> back = sweep(0.2, 4, 10, 15);
  std::reverse(back.begin(), back.end());
  const std::vector<LidarReturn> edges = depth_edges(back, {});
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_TRUE(edges[0].p_lidar.isApprox(depth_edges(sweep(0.2, 4, 10, 15), {})[0].p_lidar));
  EXPECT_EQ(edges[0].t_ns, 30'000);
}

TEST(DepthEdges, NeedAStepThatIsLargeForTheRange) {
  EXPECT_TRUE(depth_edges(sweep(0.2, 4, 10, 10.2), {}).empty());
  EXPECT_EQ(depth_edges(sweep(0.2, 4, 10, 10.3), {}).size(), 1u);
  EXPECT_TRUE(depth_edges(sweep(0.2, 4, 100, 101.9), {}).empty());
  EXPECT_EQ(depth_edges(sweep(0.2, 4, 100, 102.1), {}).size(), 1u);
}

TEST(DepthEdges, BeamsFarApartAreNoNeighbours) {
  EXPECT_TRUE(depth_edges(sweep(0.6, 4, 10, 15), {}).empty());
  EXPECT_TRUE(depth_edges({}, {}).empty());
}

}  // namespace
}  // namespace alight
