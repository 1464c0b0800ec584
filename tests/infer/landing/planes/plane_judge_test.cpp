#include "infer/landing/planes/plane_judge.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "infer/landing/site_selector.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::camera_at;
using scenes::camera_of;
using scenes::plane_seen;

SiteSelectionConfig planes() {
  SiteSelectionConfig config;
  config.method = LandingMethod::kPlaneFit;
  return config;
}

class PlaneJudgeSlope : public testing::TestWithParam<double> {};

TEST_P(PlaneJudgeSlope, IsDecidedTheSameFromEveryHeight) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const double gradient = std::tan(to_radians(GetParam()));
  for (const double height_m : {8.0, 20.0, 40.0}) {
    const Eigen::Isometry3d T = camera_at(0.1, 0.2, height_m, 10, -12, 0.3);
    const SiteSelection selection =
        SiteSelector(planes(), k).select(plane_seen(k, T, 0, gradient * 0.6, gradient * 0.8), T);
    const int safe = cv::countNonZero(selection.safe);
    if (GetParam() < 10) EXPECT_GT(safe, 0.3 * cv::countNonZero(selection.terrain.known)) << height_m;
    if (GetParam() > 10) EXPECT_EQ(safe, 0) << height_m;
  }
}
INSTANTIATE_TEST_SUITE_P(Planes, PlaneJudgeSlope, testing::Values(0.0, 5.0, 9.0, 11.0, 20.0));

TEST(PlaneJudge, CirclesLieInTheWorldWhereTheyAre) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const Eigen::Isometry3d T = camera_at(40, -25, 20, 6, 4, 0.8);
  cv::Mat depth = plane_seen(k, T, 0, 0, 0);
  // Only a disc of 4 m around (41, -24) is known.
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d p = T * (k.ray(u, v) * static_cast<double>(depth.at<float>(v, u)));
      if (std::hypot(p.x() - 41, p.y() + 24) > 4) depth.at<float>(v, u) = 0;
    }
  }
  const SiteSelection selection = SiteSelector(planes(), k).select(depth, T);
  ASSERT_TRUE(selection.found());
  EXPECT_NEAR(selection.largest->p_world.x(), 41, 0.25);
  EXPECT_NEAR(selection.largest->p_world.y(), -24, 0.25);
  EXPECT_NEAR(selection.largest->p_world.z(), 0, 1e-3);
  EXPECT_LE(selection.largest->radius_m, 4 - 0.6 + 1e-6) << "less the disc";
  EXPECT_GT(selection.largest->radius_m, 4 - 0.6 - 0.45);
  const auto there = circle_at(selection, k, selection.largest->centre_px);
  ASSERT_TRUE(there);
  EXPECT_NEAR(there->radius_m, selection.largest->radius_m, 0.1);
}

TEST(PlaneJudge, WiresMakeTheGroundBelowThemUnsafe) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = scenes::level_ground(k, 20);
  depth.col(276).setTo(10);  // 2.27 m right of the camera and 10 m up; seen where the ground is 4.55 m right
  const SiteSelection selection = SiteSelector(planes(), k).select(depth, camera_at(0, 0, 20));
  ASSERT_TRUE(selection.largest);
  EXPECT_GT(std::abs(selection.largest->p_world.x() - 100.0 / 440 * 10), selection.largest->radius_m);
  EXPECT_EQ(selection.safe.at<std::uint8_t>(176, 226), 0);
}

TEST(PlaneJudge, UnknownAndUnconfidentGroundIsAHazard) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const cv::Mat depth = scenes::level_ground(k, 20);
  cv::Mat confidence(depth.size(), CV_32FC1, cv::Scalar(0.9));
  confidence(cv::Rect(0, 0, 176, 352)).setTo(0.2);
  const SiteSelection selection = SiteSelector(planes(), k).select(depth, camera_at(0, 0, 20), confidence);
  EXPECT_EQ(cv::countNonZero(selection.safe(cv::Rect(0, 0, 176, 352))), 0);
  EXPECT_GT(cv::countNonZero(selection.safe), 10000);
  ASSERT_TRUE(selection.found());
  EXPECT_GT(selection.largest->p_level.x(), selection.largest->radius_m);
  EXPECT_NEAR(selection.sites.front().confidence, 0.9, 0.01);
}

TEST(PlaneJudge, RoofsAreNotGround) {
  const PinholeIntrinsics k = camera_of(352, 352);
  cv::Mat depth = scenes::level_ground(k, 30);
  scenes::change(depth, k, 26, [](double x, double y) { return std::abs(x) < 4.5 && std::abs(y) < 4.5; }, 26);
  SiteSelectionConfig config = planes();
  const SiteSelection warned = SiteSelector(config, k).select(depth, camera_at(0, 0, 30));
  EXPECT_EQ(warned.safe.at<std::uint8_t>(176, 176), 0);
  EXPECT_EQ(warned.safe.at<std::uint8_t>(176, 300), 255);
  config.plane_fit.platform_height_m = 0;
  EXPECT_EQ(SiteSelector(config, k).select(depth, camera_at(0, 0, 30)).safe.at<std::uint8_t>(176, 176), 255);
}

TEST(PlaneJudge, GroundBelowACrownBesideTheImageIsNotSafe) {
  // The crown itself is not in the image, so nothing but its absence can be told.
  const PinholeIntrinsics k = camera_of(352, 352);
  SiteSelectionConfig config = planes();
  const cv::Mat depth = scenes::level_ground(k, 12);
  const auto safe_half_m = [&] {
    const SiteSelection s = SiteSelector(config, k).select(depth, scenes::attitude(0, 0));
    return std::sqrt(cv::countNonZero(s.safe)) / 2 * 12 / 440;
  };
  EXPECT_NEAR(safe_half_m(), 0.4 * 12 - 0.6, 0.3);
  config.plane_fit.column_m = 4;
  EXPECT_NEAR(safe_half_m(), 0.4 * (12 - 4), 0.2);
}

TEST(PlaneJudge, HazardsHaveToFitTheRasterAndMakeGroundUnsafe) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const Eigen::Isometry3d T = camera_at(3, -2, 20);
  const SiteSelector selector(planes(), k);
  const SiteSelection seen = selector.look(scenes::level_ground(k, 20), T);
  cv::Mat hazards = cv::Mat::zeros(seen.ground.raster.size(), CV_8UC1);
  const SiteSelection plain = selector.decide(seen, hazards, T);
  int column = 0;
  int row = 0;
  ASSERT_TRUE(seen.ground.raster.cell_at(4, -2, column, row));
  ASSERT_EQ(plain.ground.safe.at<std::uint8_t>(row, column), 255);
  hazards.at<std::uint8_t>(row, column) = 1;
  const SiteSelection told = selector.decide(seen, hazards, T);
  EXPECT_EQ(told.ground.safe.at<std::uint8_t>(row, column), 0);
  EXPECT_EQ(told.ground.safe.at<std::uint8_t>(row, column + 1), 0) << "guard_m";
  EXPECT_LT(told.largest->radius_m, plain.largest->radius_m);
  EXPECT_THROW(selector.decide(seen, hazards.rowRange(1, hazards.rows), T), std::invalid_argument);
  EXPECT_THROW(selector.decide(seen, cv::Mat::zeros(hazards.size(), CV_32FC1), T), std::invalid_argument);
  const SiteSelection nothing = selector.look(cv::Mat::zeros(k.size(), CV_32FC1), T);
  EXPECT_THROW(selector.decide(nothing, hazards, T), std::invalid_argument) << "no raster at all";
  EXPECT_EQ(selector.decide(nothing, {}, T).status, SiteStatus::kNoDepth);
}

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// Depth of level ground at z = 0 with boxes on it, what they hide left out.
cv::Mat boxes_seen(const PinholeIntrinsics& k, const Eigen::Isometry3d& T, const std::vector<Box>& boxes) {
  cv::Mat depth = cv::Mat::zeros(k.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Array3d ray = T.linear() * k.ray(u, v);
      const Eigen::Array3d from = T.translation();
      double z_m = -from.z() / ray.z();
      for (const Box& box : boxes) {
        const Eigen::Array3d a = (box.low.array() - from) / ray;
        const Eigen::Array3d b = (box.high.array() - from) / ray;
        const double enter = a.min(b).maxCoeff();
        if (enter < a.max(b).minCoeff()) z_m = std::min(z_m, enter);
      }
      depth.at<float>(v, u) = static_cast<float>(z_m);
    }
  }
  return depth;
}

TEST(PlaneJudge, ARoofWhoseParapetsHideWhatIsBehindThemIsNoGround) {
  const PinholeIntrinsics k = camera_of(352, 352);
  // 8 m high, parapets of 0.4 m, something on top, the eastern end outside the image. From 20 m up only the ground
  // behind the western edge is seen within a few metres.
  const std::vector<Box> house = {{{-0.8, -3.8, 0}, {6, 3.8, 8}},
                                  {{-0.8, -3.8, 8}, {-0.4, 3.8, 8.4}},
                                  {{-0.8, -3.8, 8}, {6, -3.4, 8.4}},
                                  {{-0.8, 3.4, 8}, {6, 3.8, 8.4}},
                                  {{1.5, -0.9, 8}, {2.7, 0.3, 9}}};
  const Eigen::Isometry3d T = camera_at(0, 0, 20);
  for (const double noise_m : {0.0, 0.02}) {
    SiteSelectionConfig config = planes();
    config.plane_fit.noise_m = noise_m;
    const auto safe_on_roof = [&] {
      const cv::Mat depth = boxes_seen(k, T, house);
      const cv::Mat safe = SiteSelector(config, k).select(depth, T).safe;
      return cv::countNonZero(safe & (depth < 12.5));
    };
    EXPECT_EQ(safe_on_roof(), 0) << noise_m;
    config.plane_fit.platform_height_m = 0;
    EXPECT_GT(safe_on_roof(), 500) << noise_m;
  }
}

TEST(PlaneJudge, SitesAreSeparateAndTheBestScoreComesFirst) {
  const PinholeIntrinsics k = camera_of(352, 352);
  cv::Mat depth = scenes::level_ground(k, 40);
  depth(cv::Rect(150, 0, 12, 352)).setTo(36);  // a wall
  depth(cv::Rect(0, 150, 352, 12)).setTo(36);
  const SiteSelection selection = SiteSelector(planes(), k).select(depth, camera_at(0, 0, 40));
  ASSERT_GE(selection.sites.size(), 3U);
  for (std::size_t i = 0; i < selection.sites.size(); ++i) {
    const LandingSite& a = selection.sites[i];
    EXPECT_GT(a.radius_m, 2);
    EXPECT_LE(a.radius_m, selection.largest->radius_m);
    if (i > 0) EXPECT_LE(a.score, selection.sites[i - 1].score);
    for (std::size_t j = 0; j < i; ++j) {
      const LandingSite& b = selection.sites[j];
      EXPECT_GT((a.p_world - b.p_world).norm(), std::max(a.radius_m, b.radius_m));
    }
  }
}

}  // namespace
}  // namespace alight
