#include "sim/site/ground_shape.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

const Relief kHills({{{50, 4.0}, {18, 1.5}, {6, 0.40}, {2, 0.07}}}, 3);
const Relief kFlat({{{50, 0}, {18, 0}, {6, 0}, {2, 0}}}, 3);

TEST(GroundShape, ALevellingHoldsWithinItsMarginAndEndsBeyondItsFalloff) {
  SiteLayout layout(60);
  Levelling levelling;
  levelling.rect.centre = {5, 2};
  levelling.margin_m = 4;
  levelling.height_m = 7;
  levelling.gradient = {0.1, 0};
  layout.clearings.push_back(levelling);
  EXPECT_NEAR(shaped_height_m(kHills, layout, {5, 2}), 7, 1e-12);
  EXPECT_NEAR(shaped_height_m(kHills, layout, {8, 2}), 7.3, 1e-12);
  const Eigen::Vector2d beyond(5, 9.1);
  EXPECT_EQ(shaped_height_m(kHills, layout, beyond), kHills.height_m(beyond));
}

TEST(GroundShape, ARoadIsLevelAcrossAndFollowsTheSmoothReliefAlong) {
  SiteLayout layout(60);
  layout.roads.push_back({{{-100, 0}, {100, 0}}, 6, 0});
  for (double x_m = -25; x_m < 25; x_m += 3.1) {
    for (const double y_m : {-3.9, 0.0, 3.9}) {  // its width and a metre each side
      EXPECT_NEAR(shaped_height_m(kHills, layout, {x_m, y_m}), kHills.smooth_m({x_m, 0}), 1e-12);
    }
  }
}

TEST(GroundShape, ABuildingsGroundIsCutIntoWhatClearingsLeft) {
  SiteLayout layout(60);
  Levelling clearing;
  clearing.margin_m = 10;
  clearing.height_m = 1;
  layout.clearings.push_back(clearing);
  Levelling ground;
  ground.rect = {{3, 0}, 2, 2};
  ground.height_m = 5;
  layout.building_grounds.push_back(ground);
  EXPECT_NEAR(shaped_height_m(kFlat, layout, {3, 1}), 5, 1e-12);
  EXPECT_NEAR(shaped_height_m(kFlat, layout, {-3, 0}), 1, 1e-12);
}

TEST(GroundShape, AMoundIsABell) {
  SiteLayout layout(60);
  layout.mounds.push_back({{4, 0}, 3, 2});
  EXPECT_NEAR(shaped_height_m(kFlat, layout, {4, 0}), 2, 1e-12);
  EXPECT_NEAR(shaped_height_m(kFlat, layout, {7, 0}), 2 * std::exp(-0.5), 1e-12);
  EXPECT_EQ(shaped_height_m(kFlat, layout, {17, 0}), 0);
}

TEST(GroundShape, TheOriginIsOnTheGroundAndPondsKeepTheirPlaceInIt) {
  SiteLayout layout(60);
  layout.ponds.push_back({{15, 0}, 5, 2.0});
  const double above_m = shaped_height_m(kHills, layout, {0, 0});
  const Terrain terrain = shape_ground(60, 0, kHills, layout);
  EXPECT_NEAR(terrain.height_m(0, 0), 0, 1e-6);
  EXPECT_NEAR(layout.ponds[0].level_m, 2.0 - above_m,
              0.02);  // the mesh meets the relief at its corners alone
  EXPECT_LT(terrain.height_m(15, 0), layout.ponds[0].level_m - 0.9);
  // The bank stands out all around.
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const Eigen::Vector2d p = layout.ponds[0].centre + 5.1 * heading(angle);
    EXPECT_GT(terrain.height_m(p.x(), p.y()), layout.ponds[0].level_m) << angle;
  }
}

}  // namespace
}  // namespace alight::sim
