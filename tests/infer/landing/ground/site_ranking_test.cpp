#include "infer/landing/ground/site_ranking.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(Score, EveryTermPullsItsWay) {
  const SiteRankingConfig config;
  LandingSite site;
  site.radius_m = 3;
  site.slope_rad = 0.05;
  site.obstacle_m = 5;
  site.distance_m = 10;
  site.confidence = 0.8;
  const double base = score(site, config, 2, 0.17);
  EXPECT_GT(base, 0);
  EXPECT_LT(base, 1);
  const auto changed = [&](double LandingSite::* field, double value) {
    LandingSite other = site;
    other.*field = value;
    return score(other, config, 2, 0.17);
  };
  EXPECT_GT(changed(&LandingSite::radius_m, 4), base);
  EXPECT_LT(changed(&LandingSite::slope_rad, 0.1), base);
  EXPECT_GT(changed(&LandingSite::obstacle_m, 9), base);
  EXPECT_LT(changed(&LandingSite::distance_m, 30), base);
  EXPECT_GT(changed(&LandingSite::confidence, 1), base);
}

}  // namespace
}  // namespace alight
