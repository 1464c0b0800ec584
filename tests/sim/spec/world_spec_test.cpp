#include "sim/spec/world_spec.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

WorldSpec spec_of(double size_m, const std::vector<std::string>& hard = {}) {
  WorldConfig config;
  config.size_m = size_m;
  config.hard.names = hard;
  return WorldSpec(config);
}

TEST(WorldSpec, CountsGrowWithTheAreaButNeverFromOrToNone) {
  EXPECT_EQ(spec_of(160).scaled(26), 26);
  EXPECT_EQ(spec_of(320).scaled(26), 104);
  EXPECT_EQ(spec_of(60).scaled(2), 1);  // 0.28
  EXPECT_EQ(spec_of(320).scaled(0), 0);
}

TEST(WorldSpec, SnowCoversNaturalGroundAlone) {
  const WorldSpec snow = spec_of(100, {"snow"});
  EXPECT_EQ(snow.cover(Material::kGrass), Material::kSnow);
  EXPECT_EQ(snow.cover(Material::kRock), Material::kSnow);
  EXPECT_EQ(snow.cover(Material::kAsphalt), Material::kAsphalt);
  EXPECT_EQ(spec_of(100).cover(Material::kGrass), Material::kGrass);
}

TEST(WorldSpec, AStepDrawsTheSameEachTimeAndNotWhatAnotherDraws) {
  const WorldSpec spec = spec_of(100);
  Random trees = spec.stream(BuildStep::kTrees);
  EXPECT_EQ(spec.stream(BuildStep::kTrees).next(), trees.next());
  EXPECT_NE(spec.stream(BuildStep::kTrees).next(), spec.stream(BuildStep::kBoulders).next());
}

TEST(WorldSpec, TheSquareHasTheOriginInItsMiddle) {
  const WorldSpec spec = spec_of(100);
  EXPECT_FALSE(spec.is_outside({-49.9, 49.9}));
  EXPECT_TRUE(spec.is_outside({0, 50.1}));
  EXPECT_TRUE(spec.is_outside({-50.1, 0}));
}

}  // namespace
}  // namespace alight::sim
