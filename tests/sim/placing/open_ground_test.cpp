#include "sim/placing/open_ground.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

TEST(OpenGround, AQuarterOfThePlacesLiesInClearingsThoughTheyAreKept) {
  SitePlan plan(100);
  Levelling clearing;
  clearing.rect.centre = {20, 10};
  clearing.margin_m = 6;
  plan.occupy_disc(clearing.rect.centre, clearing.margin_m);
  Random random(2, 1);
  int inside = 0;
  constexpr int kPlaces = 2000;
  for (int i = 0; i < kPlaces; ++i) {
    const auto at = find_open(plan, {clearing}, random, 1, 50);
    ASSERT_TRUE(at);
    const double away_m = (*at - clearing.rect.centre).norm();
    if (away_m < 6) {
      EXPECT_LE(away_m, 5);  // all of it in the clearing
      ++inside;
    } else {
      EXPECT_TRUE(plan.is_free(*at, 1));
    }
  }
  EXPECT_NEAR(inside / static_cast<double>(kPlaces), 0.25, 0.03);
}

TEST(OpenGround, WithoutClearingsOnlyFreeGroundWillDo) {
  SitePlan plan(20);
  plan.occupy_rect({{0, 0}, 10, 10}, 0);
  Random random(2, 1);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(find_open(plan, {}, random, 0.5, 10));
}

}  // namespace
}  // namespace alight::sim
