#include "train/evaluation/scores/regions.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/train/evaluation/evaluation_scenes.hpp"

namespace alight {
namespace {

cv::Mat level_m(double depth_m, int side_px = 48) {
  return cv::Mat(side_px, side_px, CV_32FC1, cv::Scalar(depth_m));
}

int count(const std::optional<SampleRegions::Pixels>& pixels) {
  if (!pixels) return -1;
  return cv::countNonZero(pixels->mask.empty() ? pixels->truth_m > 0 : pixels->mask & (pixels->truth_m > 0));
}

TEST(NearEdges, AStepIsSeenFromBothSidesUpToTheDistance) {
  cv::Mat truth_m = level_m(20, 20);
  truth_m.colRange(10, 20).setTo(21);
  RegionConfig config;
  config.edge_distance_px = 3;
  const cv::Mat near = near_edges(truth_m, config);
  for (int u = 0; u < 20; ++u) EXPECT_EQ(near.at<std::uint8_t>(9, u) != 0, u >= 6 && u <= 13) << u;
}

TEST(NearEdges, BothThresholdsMustBeExceeded) {
  RegionConfig config;
  config.edge_distance_px = 0;
  const auto edges = [&](double from_m, double to_m) {
    cv::Mat truth_m = level_m(from_m, 6);
    truth_m.rowRange(3, 6).setTo(to_m);
    return cv::countNonZero(near_edges(truth_m, config));
  };
  EXPECT_EQ(edges(10, 10.4), 0);   // 4 %, but 0.4 m
  EXPECT_EQ(edges(40, 41), 0);     // 1 m, but 2.5 %
  EXPECT_EQ(edges(10, 10.6), 12);  // a row on either side
  EXPECT_EQ(edges(10, 0), 0);      // missing truth is no edge
}

TEST(SampleRegions, FovIsTheCircleAroundTheBoresight) {
  const SampleRegions regions(level_m(15), level_m(15), test::scene_rig(), {});
  const auto inside = regions.pixels(Region::kInsideFov, level_m(0));
  const double radius_px = 40 * std::tan(to_radians(19.174));
  EXPECT_NEAR(count(inside), kPi * radius_px * radius_px, 20);
  EXPECT_NE(inside->mask.at<std::uint8_t>(24, 24), 0);
  EXPECT_EQ(count(inside) + count(regions.pixels(Region::kOutsideFov, level_m(0))), 48 * 48);
}

TEST(SampleRegions, HeldOutIsWhatWasNotFed) {
  cv::Mat lidar_m = level_m(0);
  lidar_m.rowRange(0, 2).setTo(12);
  cv::Mat fed_m = level_m(0);
  fed_m.row(0).setTo(12);
  const SampleRegions regions(lidar_m, {}, test::scene_rig(), {});
  EXPECT_EQ(count(regions.pixels(Region::kAll, fed_m)), 96);
  EXPECT_EQ(count(regions.pixels(Region::kHeldOut, fed_m)), 48);
}

TEST(SampleRegions, AnImageIsInTheBandOfItsMedianDepth) {
  const auto band = [](double depth_m) {
    const SampleRegions regions(level_m(depth_m), level_m(depth_m), test::scene_rig(), {});
    std::string names;
    for (const Region region : {Region::kBelow10m, Region::k10To20m, Region::k20To30m, Region::kAbove30m}) {
      if (regions.pixels(region, level_m(0))) names += name(region);
    }
    return names;
  };
  EXPECT_EQ(band(9.99), "below_10m");
  EXPECT_EQ(band(10), "10_to_20m");
  EXPECT_EQ(band(29.9), "20_to_30m");
  EXPECT_EQ(band(30), "above_30m");
}

TEST(SampleRegions, WithoutDenseTruthTheLidarJudges) {
  cv::Mat lidar_m = level_m(0);
  lidar_m.row(24).setTo(25);
  const SampleRegions regions(lidar_m, {}, test::scene_rig(), {});
  EXPECT_EQ(count(regions.pixels(Region::kDense, level_m(0))), -1);
  EXPECT_EQ(count(regions.pixels(Region::kNearEdges, level_m(0))), -1);
  EXPECT_EQ(count(regions.pixels(Region::k20To30m, level_m(0))), 48);
  EXPECT_GT(count(regions.pixels(Region::kInsideFov, level_m(0))), 0);
}

TEST(SampleRegions, ASampleWithoutAnyTruthHasNoRegion) {
  const SampleRegions regions(level_m(0), {}, test::scene_rig(), {});
  for (const Region region : kRegions) EXPECT_FALSE(regions.pixels(region, level_m(0))) << name(region);
}

TEST(SampleRegions, MapsOfAnotherSizeAreRefused) {
  EXPECT_THROW(SampleRegions(level_m(5, 47), {}, test::scene_rig(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace alight
