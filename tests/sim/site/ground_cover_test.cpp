#include "sim/site/ground_cover.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

WorldSpec village(const std::vector<std::string>& hard = {}) {
  WorldConfig config;  // shoulders of half a metre
  config.size_m = 60;
  config.hard.names = hard;
  return WorldSpec(config);
}

TEST(GroundCover, WhatPeopleMadeLiesOverWhatGrows) {
  const WorldSpec spec = village();
  SurfaceTable surfaces(1);
  const CoverSurfaces covers = add_cover_surfaces(spec, surfaces);
  SiteLayout layout(60);
  layout.roads.push_back({{{-100, 0}, {100, 0}}, 6, 100});
  layout.plots.push_back({{{0, 10}, 12, 12}, 101, false});
  layout.ponds.push_back({{0, 4}, 3, 0});  // its south lies under the road
  Levelling ground;
  ground.rect = {{0, 16}, 3, 2};
  layout.building_grounds.push_back(ground);
  Terrain terrain(60, 0);
  paint_ground(spec, layout, covers, terrain);
  EXPECT_EQ(terrain.cover(0, 2.5), 100);
  EXPECT_EQ(terrain.cover(0, 3.2), covers.shoulder);
  EXPECT_EQ(terrain.cover(0, 4.5), covers.mud);
  EXPECT_EQ(terrain.cover(0, 7.2), covers.mud);  // half a metre around it, too
  EXPECT_EQ(terrain.cover(0, 9), 101);
  EXPECT_EQ(terrain.cover(0, 13.5), covers.shoulder);  // beside the walls
  EXPECT_EQ(terrain.cover(11, 11), 101);
  const std::uint16_t natural = terrain.cover(-20, -20);
  EXPECT_TRUE(natural == covers.ground || natural == covers.ground_alt || natural == covers.patches);
  EXPECT_TRUE(terrain.is_cover_border(0, 3.0));
  EXPECT_FALSE(terrain.is_cover_border(0, 0));
}

TEST(GroundCover, SnowLiesOnNaturalGroundAlone) {
  const WorldSpec spec = village({"snow"});
  SurfaceTable surfaces(1);
  const CoverSurfaces covers = add_cover_surfaces(spec, surfaces);
  for (const std::uint16_t natural : {covers.ground, covers.ground_alt, covers.patches}) {
    EXPECT_EQ(surfaces.all()[natural].material, Material::kSnow);
  }
  EXPECT_NE(surfaces.all()[covers.shoulder].material, Material::kSnow);
}

}  // namespace
}  // namespace alight::sim
