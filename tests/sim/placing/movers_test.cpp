#include "sim/placing/movers.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

class Movers : public ::testing::Test {
 protected:
  Movers() : spec_(WorldConfig{}), terrain_(160, 0), plan_(160), placer_(spec_, terrain_, plan_) {}

  WorldSpec spec_;
  Terrain terrain_;
  SitePlan plan_;
  ObjectPlacer placer_;
  SurfaceTable surfaces_{1};
};

TEST_F(Movers, TrafficKeepsToItsRightLaneWithinTheSquare) {
  const Road road{{{-240, 5}, {240, 5}}, 6, 0};
  const std::vector<Mover> cars = drive_traffic(spec_, {road}, surfaces_, placer_);
  ASSERT_EQ(cars.size(), 8U);
  for (const Mover& car : cars) {
    const Eigen::Vector3f ahead = car.R_world_mesh().col(0);
    for (double t_s = 0; t_s < 60; t_s += 0.7) {
      EXPECT_NEAR(car.p_world(t_s).y(), ahead.x() > 0 ? 3.5 : 6.5, 1e-4);
      EXPECT_LE(std::abs(car.p_world(t_s).x()), 80);
    }
  }
}

TEST_F(Movers, WithoutRoadsNothingDrives) {
  EXPECT_TRUE(drive_traffic(spec_, {}, surfaces_, placer_).empty());
  EXPECT_TRUE(placer_.meshes().empty());
}

TEST_F(Movers, NobodyWalksThroughWhatStands) {
  for (double x_m = -75; x_m < 80; x_m += 15) plan_.occupy_segment({{x_m, -80}, {x_m, 80}}, 1);
  const std::vector<Mover> people = walk_people(spec_, surfaces_, placer_);
  ASSERT_GT(people.size(), 5U);
  for (const Mover& person : people) {
    for (double t_s = 0; t_s < 60; t_s += 0.3) {
      const Eigen::Vector2d p = person.p_world(t_s).head<2>().cast<double>();
      EXPECT_TRUE(plan_.is_free(p, 0.05)) << p.transpose();
    }
  }
}

TEST_F(Movers, AVisitorSetsOutWhenItIsToldAndStays) {
  VisitorConfig visitor;
  visitor.kind = VisitorKind::kPerson;
  visitor.from_x_m = 10;
  visitor.to_y_m = 10;
  visitor.begin_s = 3;
  visitor.speed_mps = 2;
  const Mover mover = send_visitor(visitor, surfaces_, placer_);
  EXPECT_TRUE(mover.p_world(2.9).isApprox(Eigen::Vector3f(10, 0, 0), 1e-5F));
  EXPECT_TRUE(mover.p_world(3 + 5 * std::sqrt(0.5)).isApprox(Eigen::Vector3f(5, 5, 0), 1e-4F));
  EXPECT_TRUE(mover.p_world(60).isApprox(Eigen::Vector3f(0, 10, 0), 1e-5F));
}

}  // namespace
}  // namespace alight::sim
