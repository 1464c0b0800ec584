#include "sim/site/site_plan.hpp"

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

const Eigen::Vector2d kOrigin = Eigen::Vector2d::Zero();

TEST(SitePlan, WhatIsOccupiedIsNotFreeNorIsTheOutside) {
  SitePlan plan(40);
  EXPECT_TRUE(plan.is_free(kOrigin, 5));
  plan.occupy_disc(kOrigin, 2);
  EXPECT_FALSE(plan.is_free(kOrigin, 0.1));
  EXPECT_FALSE(plan.is_free(Eigen::Vector2d(5, 0), 4));
  EXPECT_TRUE(plan.is_free(Eigen::Vector2d(8, 0), 4));
  EXPECT_FALSE(plan.is_free(Eigen::Vector2d(18, 0), 4));  // reaches over the border
}

TEST(SitePlan, ASegmentTakesItsWidthAndNoMore) {
  SitePlan plan(40);
  plan.occupy_segment({{-30, 0}, {30, 0}}, 3);
  for (double x_m = -19; x_m < 19; x_m += 1.3) {
    EXPECT_FALSE(plan.is_free(Eigen::Vector2d(x_m, 2.9), 0.2)) << x_m;
    EXPECT_TRUE(plan.is_free(Eigen::Vector2d(x_m, -5), 0.9)) << x_m;
  }
}

TEST(SitePlan, FindsNothingWhereAllIsTaken) {
  SitePlan plan(40);
  Random random(1, 1);
  ASSERT_TRUE(plan.find_free(random, 2, 20, 100));
  plan.occupy_rect({kOrigin, 20, 20}, 1);
  EXPECT_FALSE(plan.find_free(random, 0.5, 20, 1000));
}

TEST(SitePlan, WhatItFindsIsFreeAndNearEnough) {
  SitePlan plan(40);
  plan.occupy_rect({kOrigin, 6, 3}, 0.5);
  Random random(1, 1);
  for (int i = 0; i < 200; ++i) {
    const auto at = plan.find_free(random, 1.5, 10, 100);
    ASSERT_TRUE(at);
    EXPECT_TRUE(plan.is_free(*at, 1.5));
    EXPECT_LE(at->cwiseAbs().maxCoeff(), 10);
  }
}

}  // namespace
}  // namespace alight::sim
