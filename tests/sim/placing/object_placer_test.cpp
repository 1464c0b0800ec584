#include "sim/placing/object_placer.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

class ObjectPlacerTest : public ::testing::Test {
 protected:
  ObjectPlacerTest() : spec_(WorldConfig{}), terrain_(160, 0), plan_(160), placer_(spec_, terrain_, plan_) {
    for (int row = 0; row < terrain_.grid_size(); ++row) {
      for (int column = 0; column < terrain_.grid_size(); ++column) {
        terrain_.vertex_height_m(row, column) = static_cast<float>(0.1 * terrain_.axis_m(column));
      }
    }
  }
  Eigen::Vector3f position(std::size_t i) { return placer_.placements()[i].T_world_mesh.translation(); }

  WorldSpec spec_;
  Terrain terrain_;  // a slope towards the west
  SitePlan plan_;
  ObjectPlacer placer_;
};

TEST_F(ObjectPlacerTest, PutsOnTheGroundAndSinksIntoIt) {
  const std::size_t mesh = placer_.add_mesh({});
  placer_.put(mesh, {10, 3}, 0.2, 0, 2);
  ASSERT_EQ(placer_.placements().size(), 1U);
  EXPECT_EQ(placer_.placements()[0].mesh, mesh);
  EXPECT_TRUE(position(0).isApprox(Eigen::Vector3f(10, 3, 0.8F), 1e-5F));
  EXPECT_TRUE(placer_.placements()[0].T_world_mesh.linear().isApprox(2 * Eigen::Matrix3f::Identity()));
}

TEST_F(ObjectPlacerTest, WhatTakesGroundKeepsApart) {
  Random random(1, 1);
  placer_.scatter(random, {placer_.add_mesh({}), placer_.add_mesh({})}, {150, 1, 3, 1.0, true, 0});
  const std::size_t count = placer_.placements().size();
  ASSERT_GT(count, 100U);
  for (std::size_t i = 0; i < count; ++i) {
    const float scale = placer_.placements()[i].T_world_mesh.linear().col(0).norm();
    EXPECT_GE(scale, 1);
    EXPECT_LE(scale, 3);
    for (std::size_t k = 0; k < i; ++k) {
      const float other = placer_.placements()[k].T_world_mesh.linear().col(0).norm();
      EXPECT_GT((position(i) - position(k)).head<2>().norm(), scale + other - 0.001F);
    }
  }
}

TEST_F(ObjectPlacerTest, WhatTakesNoGroundLeavesThePlanAsItWas) {
  Random random(1, 1);
  placer_.scatter(random, {placer_.add_mesh({})}, {100, 1, 1, 0.5, false, 0});
  ASSERT_EQ(placer_.placements().size(), 100U);
  EXPECT_TRUE(plan_.is_free(Eigen::Vector2d(0, 0), 79));
}

TEST_F(ObjectPlacerTest, WhatFindsNoGroundIsLeftOut) {
  Random random(1, 1);
  plan_.occupy_rect({{0, 0}, 80, 80}, 0);
  placer_.scatter(random, {placer_.add_mesh({})}, {20, 1, 1, 0.5, true, 0});
  EXPECT_TRUE(placer_.placements().empty());
}

}  // namespace
}  // namespace alight::sim
