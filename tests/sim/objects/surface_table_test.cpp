#include "sim/objects/surface_table.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

TEST(SurfaceTable, TwinsDifferInTheirSeedsAlone) {
  SurfaceTable table(5);
  EXPECT_EQ(table.add(Material::kGrass, {1, 2, 3}), 0);
  EXPECT_EQ(table.add(Material::kGrass, {1, 2, 3}), 1);
  EXPECT_EQ(table.all()[0].material, table.all()[1].material);
  EXPECT_EQ(table.all()[0].tint_rgb, table.all()[1].tint_rgb);
  EXPECT_NE(table.all()[0].seed, table.all()[1].seed);
}

TEST(SurfaceTable, SeedsFollowFromTheTablesSeedAndThePlace) {
  SurfaceTable one(5), same(5), other(6);
  for (SurfaceTable* table : {&one, &same, &other}) table->add(Material::kSoil);
  EXPECT_EQ(one.all()[0].seed, same.all()[0].seed);
  EXPECT_NE(one.all()[0].seed, other.all()[0].seed);
}

TEST(SurfaceTable, AFrameIsLevelAndRightHanded) {
  SurfaceTable table(1);
  const Surface& road = table.all()[table.add_framed(Material::kAsphalt, {3, 4}, {0.6, 0.8}, 6)];
  EXPECT_TRUE(road.framed);
  EXPECT_EQ(road.origin, Eigen::Vector3f(3, 4, 0));
  EXPECT_EQ(road.width_m, 6);
  EXPECT_TRUE(road.u_axis.cross(road.v_axis).isApprox(Eigen::Vector3f::UnitZ()));
}

TEST(SurfaceTable, ASurfaceAsItIsKeepsItsSeed) {
  SurfaceTable table(1);
  Surface surface;
  surface.seed = 77;
  EXPECT_EQ(table.all()[table.add(surface)].seed, 77U);
}

}  // namespace
}  // namespace alight::sim
