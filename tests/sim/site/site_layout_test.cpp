#include "sim/site/site_layout.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/site/building_layout.hpp"
#include "sim/site/landform_layout.hpp"
#include "sim/site/plot_layout.hpp"
#include "sim/site/road_layout.hpp"

namespace alight::sim {
namespace {

/// A site laid out as far as its buildings.
struct LaidOut {
  explicit LaidOut(Look look, const std::vector<std::string>& hard = {}, int seed = 3)
      : spec(config_of(look, hard, seed)), relief(spec.look().relief, seed), surfaces(seed), layout(160) {
    layout.yaw_rad = 0.3;
    lay_roads(spec, surfaces, layout);
    lay_plots(spec, surfaces, layout);
    lay_clearings(spec, relief, layout);
    lay_building_grounds(spec, relief, layout);
  }
  static WorldConfig config_of(Look look, const std::vector<std::string>& hard, int seed) {
    WorldConfig config;
    config.look = look;
    config.seed = seed;
    config.hard.names = hard;
    return config;
  }

  WorldSpec spec;
  Relief relief;
  SurfaceTable surfaces;
  SiteLayout layout;
};

TEST(RoadLayout, EveryLookHasItsNet) {
  EXPECT_EQ(LaidOut(Look::kRocky).layout.roads.size(), 0U);
  EXPECT_EQ(LaidOut(Look::kForest).layout.roads.size(), 1U);
  EXPECT_EQ(LaidOut(Look::kVillage).layout.roads.size(), 2U);
  const std::vector<Road> grid = LaidOut(Look::kUrban).layout.roads;
  ASSERT_GT(grid.size(), 4U);
  for (std::size_t i = 0; i + 2 < grid.size(); ++i) {
    EXPECT_NEAR(grid[i].line.direction().dot(grid[i + 1].line.direction()), 0, 1e-9);  // they take turns
    const Eigen::Vector2d p = 0.5 * (grid[i].line.a + grid[i].line.b);
    EXPECT_NEAR((p - grid[i + 2].line.nearest(p)).norm(), kBlock_m, 1e-9);
  }
}

TEST(PlotLayout, BlocksReachFromStreetToStreet) {
  const SiteLayout layout = LaidOut(Look::kUrban).layout;
  ASSERT_FALSE(layout.plots.empty());
  for (const Plot& block : layout.plots) {
    // Four streets, of which each runs along an edge.
    int streets = 0;
    for (const Road& road : layout.roads) {
      const double away_m = (block.rect.centre - road.line.nearest(block.rect.centre)).norm();
      streets += std::abs(away_m - 0.5 * kBlock_m) < 1e-6 ? 1 : 0;
      EXPECT_GT(away_m, 0.5 * kBlock_m - 1e-6);
    }
    if (block.rect.centre.cwiseAbs().maxCoeff() < 80) {
      EXPECT_EQ(streets, 4);
    }
  }
}

TEST(PlotLayout, FieldsDoNotOverlap) {
  const std::vector<Plot> fields = LaidOut(Look::kFarmland).layout.plots;
  ASSERT_GT(fields.size(), 10U);
  for (const Plot& field : fields) {
    for (const Plot& other : fields) {
      if (&field != &other) {
        EXPECT_GT(field.rect.distance_m(other.rect.centre), 1);
      }
    }
  }
}

TEST(LandformLayout, ClearingsKeepApartFromRoadsAndMostlyFromCrops) {
  int all = 0;
  int in_crops = 0;
  for (int seed = 1; seed <= 8; ++seed) {
    const SiteLayout layout = LaidOut(Look::kFarmland, {}, seed).layout;
    for (const Levelling& clearing : layout.clearings) {
      const Eigen::Vector2d& p = clearing.rect.centre;
      for (const Road& road : layout.roads) {
        EXPECT_GT((p - road.line.nearest(p)).norm(), 0.5 * road.width_m + clearing.margin_m);
      }
      ++all;
      in_crops += std::any_of(layout.plots.begin(), layout.plots.end(), [&](const Plot& plot) {
        return plot.crop_rows && plot.rect.distance_m(p) < clearing.margin_m;
      });
    }
  }
  EXPECT_GT(all, 30);
  EXPECT_LT(in_crops, 0.15 * all);  // crops cover a third of the ground, but some middles have nothing else
}

TEST(LandformLayout, HardClearingsAreSmallAndManyAndHardSlopesSteep) {
  const auto plain = LaidOut(Look::kRocky).layout.clearings;
  const auto small = LaidOut(Look::kRocky, {"clearings"}).layout.clearings;
  const auto steep = LaidOut(Look::kRocky, {"slopes"}).layout.clearings;
  EXPECT_GT(small.size(), 2 * plain.size());
  for (const Levelling& clearing : small) EXPECT_LE(clearing.margin_m, 4);
  for (const Levelling& clearing : plain) {
    EXPECT_GE(clearing.margin_m, 4.5);
    EXPECT_LE(clearing.gradient.norm(), 0.05);
  }
  for (const Levelling& clearing : steep) {
    EXPECT_GE(clearing.gradient.norm(), std::tan(6 * 0.017453292));
    EXPECT_LE(clearing.gradient.norm(), std::tan(14.001 * 0.017453292));
  }
}

TEST(LandformLayout, TheFirstTwoClearingsLieNearTheMiddle) {
  const auto clearings = LaidOut(Look::kRocky).layout.clearings;
  ASSERT_GE(clearings.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(clearings[i].rect.centre.cwiseAbs().maxCoeff(), 0.2 * 160);
}

TEST(BuildingLayout, BuildingsKeepOffRoadsClearingsAndEachOther) {
  const SiteLayout layout = LaidOut(Look::kVillage).layout;
  ASSERT_GT(layout.building_grounds.size(), 5U);
  for (const Levelling& ground : layout.building_grounds) {
    for (const Road& road : layout.roads) {
      EXPECT_GT(ground.rect.distance_m(road.line.nearest(ground.rect.centre)), 0.5 * road.width_m);
    }
    for (const Levelling& clearing : layout.clearings) {
      EXPECT_GT(ground.rect.distance_m(clearing.rect.centre), clearing.margin_m);
    }
    for (const Levelling& other : layout.building_grounds) {
      if (&ground != &other) {
        EXPECT_GT(ground.rect.distance_m(other.rect.centre), 2.5);
      }
    }
  }
}

}  // namespace
}  // namespace alight::sim
