#include "sim/placing/street_objects.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/placing/roadside.hpp"

namespace alight::sim {
namespace {

/// Level ground of a town with a crossing in its middle.
struct TownCrossing {
  TownCrossing()
      : spec([] {
          WorldConfig config;
          config.look = Look::kUrban;
          config.size_m = 100;
          return config;
        }()),
        terrain(100, 0),
        plan(100),
        placer(spec, terrain, plan),
        roads({{{{-150, 0}, {150, 0}}, 8, 0}, {{{0, -150}, {0, 150}}, 6, 0}}) {}

  WorldSpec spec;
  Terrain terrain;
  SitePlan plan;
  ObjectPlacer placer;
  SurfaceTable surfaces{1};
  std::vector<Road> roads;
};

TEST(Roadside, LiesOnItsSideOfTheRoad) {
  const Road road{{{0, 0}, {10, 0}}, 6, 0};
  const Roadside left{&road, 1, 2};
  EXPECT_TRUE(left.at(4).isApprox(Eigen::Vector2d(7, 4)));
  EXPECT_TRUE(left.outwards().isApprox(Eigen::Vector2d(0, 1)));
  const Roadside right{&road, -1, -2};
  EXPECT_TRUE(right.at(4).isApprox(Eigen::Vector2d(3, -4)));
}

TEST(Roadside, ACrossingIsWhereAnotherRoadRuns) {
  const TownCrossing town;
  EXPECT_TRUE(is_crossing(town.roads, town.roads[0], {3.9, 4.5}));
  EXPECT_FALSE(is_crossing(town.roads, town.roads[0], {4.1, 4.5}));
}

TEST(StreetObjects, KerbsRunBesideTheirStreetsAndAreOpenAtCrossings) {
  TownCrossing town;
  add_kerbs(town.spec, town.roads, town.surfaces, town.placer);
  const TriangleMesh& kerbs = town.placer.fixed();
  ASSERT_FALSE(kerbs.vertices.empty());
  for (const Eigen::Vector3f& vertex : kerbs.vertices) {
    const Eigen::Vector2d p = vertex.head<2>().cast<double>();
    EXPECT_LT(vertex.z(), 0.131F);
    const bool on_first = std::abs(std::abs(p.y()) - 4.075) < 0.08;
    const bool on_second = std::abs(std::abs(p.x()) - 3.075) < 0.08;
    EXPECT_TRUE(on_first || on_second) << p.transpose();
    EXPECT_FALSE(on_first && std::abs(p.x()) < 3.9) << p.transpose();
    EXPECT_FALSE(on_second && std::abs(p.y()) < 4.9) << p.transpose();
  }
}

TEST(StreetObjects, LampsStandBesideRoadsAndTheirArmsReachOverThem) {
  TownCrossing town;
  Random random(1, 1);
  set_lamps(town.spec, town.roads, random, town.surfaces, town.placer);
  ASSERT_GT(town.placer.placements().size(), 5U);
  for (const Placement& lamp : town.placer.placements()) {
    const Eigen::Vector2d p = lamp.T_world_mesh.translation().head<2>().cast<double>();
    const Eigen::Vector2d tip = (lamp.T_world_mesh * Eigen::Vector3f(1.8F, 0, 6.6F)).head<2>().cast<double>();
    const auto edge_m = [&](const Eigen::Vector2d& at) {
      double nearest_m = 1e9;
      for (const Road& road : town.roads) {
        nearest_m = std::min(nearest_m, (at - road.line.nearest(at)).norm() - 0.5 * road.width_m);
      }
      return nearest_m;
    };
    EXPECT_NEAR(edge_m(p), 0.8, 1e-4);
    EXPECT_NEAR(edge_m(tip), -1.0, 1e-4);
  }
}

TEST(StreetObjects, ParkedCarsKeepToTheEdgeAndFaceAsTrafficOnTheRightDoes) {
  TownCrossing town;
  town.roads.pop_back();  // along east, so that the left side is the north
  park_cars(town.spec, town.roads, town.surfaces, town.placer);
  ASSERT_GT(town.placer.placements().size(), 10U);
  for (const Placement& car : town.placer.placements()) {
    const Eigen::Vector3f p = car.T_world_mesh.translation();
    EXPECT_NEAR(std::abs(p.y()), 0.5 * 8 - 1.2, 1e-4);
    const Eigen::Vector3f ahead = car.T_world_mesh.linear().col(0);
    EXPECT_NEAR(ahead.x(), p.y() > 0 ? -1 : 1, 1e-4);
  }
}

TEST(StreetObjects, WithoutRoadsThereAreNone) {
  TownCrossing town;
  Random random(1, 1);
  add_kerbs(town.spec, {}, town.surfaces, town.placer);
  set_lamps(town.spec, {}, random, town.surfaces, town.placer);
  park_cars(town.spec, {}, town.surfaces, town.placer);
  EXPECT_TRUE(town.placer.fixed().vertices.empty());
  EXPECT_TRUE(town.placer.placements().empty());
}

}  // namespace
}  // namespace alight::sim
