#include "infer/landing/derivatives/derivative_judge.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "infer/landing/site_selector.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::attitude;
using scenes::camera_of;
using scenes::level_ground;

const Eigen::Matrix3d kDown = attitude(0, 0);

SiteSelectionConfig derivatives() {
  SiteSelectionConfig config;
  config.method = LandingMethod::kDerivatives;
  return config;
}

/// How far inside a shape's edge safe ground begins: the derivative's baseline, half the smoothing window, and the
/// pixel grid.
double band_m(double z_m) { return 0.5 + 3 * z_m / 440; }

class SlopeClass : public testing::TestWithParam<double> {};

TEST_P(SlopeClass, IsDecidedExactly) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const double gradient = std::tan(to_radians(GetParam()));
  SiteSelectionConfig config = derivatives();
  config.derivatives.erode_px = config.derivatives.dilate_px = 1;
  const SiteSelection selection =
      SiteSelector(config, k).select(scenes::plane(k, 20, gradient * 0.6, gradient * 0.8), kDown);
  EXPECT_EQ(selection.found(), GetParam() < 10);
  const int known = cv::countNonZero(selection.terrain.known);
  ASSERT_GT(known, 50000);
  EXPECT_EQ(cv::countNonZero(selection.safe), GetParam() < 10 ? known : 0);
}
INSTANTIATE_TEST_SUITE_P(Planes, SlopeClass, testing::Values(0.0, 5.0, 9.0, 9.9, 10.1, 11.0, 20.0));

TEST(DerivativeJudge, LevelGroundIsSafeUnderAnyRollAndPitch) {
  const PinholeIntrinsics k = camera_of(352, 352);
  SiteSelectionConfig config = derivatives();
  config.derivatives.erode_px = config.derivatives.dilate_px =
      1;  // so that the corners of what is known stay
  const SiteSelector selector(config, k);
  for (const double tilt_x : {-15.0, 0.0, 7.0, 20.0}) {
    for (const double tilt_y : {-20.0, -3.0, 0.0, 12.0}) {
      for (const double z_m : {10.0, 30.0}) {
        const Eigen::Matrix3d R = attitude(to_radians(tilt_x), to_radians(tilt_y), 0.7);
        const SiteSelection selection = selector.select(scenes::level_ground_seen(k, z_m, R), R);
        // From 10 m a strong tilt leaves less than 2 m of the level view.
        const bool room = z_m > 10 || std::abs(tilt_x) + std::abs(tilt_y) < 20;
        if (room) EXPECT_TRUE(selection.found()) << tilt_x << " " << tilt_y << " " << describe(selection);
        EXPECT_EQ(cv::countNonZero(selection.safe), cv::countNonZero(selection.terrain.known))
            << tilt_x << " " << tilt_y;
      }
    }
  }
}

TEST(DerivativeJudge, SlopeIsMeasuredAgainstTheHorizonNotTheCamera) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const Eigen::Matrix3d R = attitude(to_radians(15), 0);
  // Perpendicular to the camera, so 15 degrees steep in the world.
  EXPECT_EQ(SiteSelector(derivatives(), k).select(level_ground(k, 20), R).status, SiteStatus::kNoFlatArea);
}

TEST(DerivativeJudge, RadiusFollowsFromDepthFocalLengthAndPixels) {
  const PinholeIntrinsics k = camera_of(353, 353);
  const double z_m = 20;
  cv::Mat depth = level_ground(k, z_m);
  // A disc of 4 m around (1, -0.5) m; beyond it the ground lies 5 m deeper.
  scenes::change(depth, k, z_m, [](double x, double y) { return std::hypot(x - 1.0, y + 0.5) > 4.0; }, 25.0F);
  // The surroundings would hold the larger circle in metres; they are unsafe here.
  cv::Mat rough = depth.clone();
  for (int v = 0; v < 353; ++v) {
    for (int u = 0; u < 353; ++u) {
      if (rough.at<float>(v, u) > 22 && (u / 6 + v / 6) % 2 == 0) rough.at<float>(v, u) = 27;
    }
  }
  const SiteSelection selection = SiteSelector(derivatives(), k).select(rough, kDown);
  ASSERT_TRUE(selection.found());
  const LandingSite& site = *selection.largest;
  EXPECT_NEAR(site.p_level.x(), 1.0, 3 * z_m / 440);
  EXPECT_NEAR(site.p_level.y(), -0.5, 3 * z_m / 440);
  EXPECT_NEAR(site.depth_m, z_m, 1e-4);
  EXPECT_NEAR(site.radius_m, 4.0 - band_m(z_m), 3 * z_m / 440);
  EXPECT_LT(site.radius_m, 4.0);
  EXPECT_NEAR(site.radius_m, site.depth_m / 440 * site.radius_px, 1e-6);
}

TEST(DerivativeJudge, CircleOfASquareFieldIsItsIncircle) {
  const PinholeIntrinsics k = camera_of(352, 300);
  SiteSelectionConfig config = derivatives();
  config.derivatives.erode_px = config.derivatives.dilate_px = 1;
  cv::Mat depth(k.size(), CV_32FC1, cv::Scalar(0));
  depth(cv::Rect(40, 60, 141, 141)).setTo(22.0);  // baseline 10 px; smoothing takes 2 px a side
  const SiteSelection selection = SiteSelector(config, k).select(depth, kDown);
  ASSERT_TRUE(selection.found());
  EXPECT_EQ(selection.largest->centre_px, Eigen::Vector2d(110, 130));
  // 141 - 2 * 12 = 117 safe pixels across: 58.5 px from the centre to the edge.
  EXPECT_NEAR(selection.largest->radius_px, 58.5, 0.01);
  EXPECT_NEAR(selection.largest->radius_m, 22.0 / 440 * 58.5, 1e-3);
}

TEST(DerivativeJudge, ImageBorderIsUnsafe) {
  const PinholeIntrinsics k = camera_of(201, 151);
  const SiteSelection selection =
      SiteSelector(derivatives(), k).select(level_ground(k, 44), kDown);  // baseline 5 px
  ASSERT_TRUE(selection.largest);
  EXPECT_NEAR(selection.largest->centre_px.y(), 75, 0.1);
  EXPECT_NEAR(selection.largest->radius_px, (151 - 2 * 7) / 2.0, 0.01);
}

TEST(DerivativeJudge, BoxOfThirtyCentimetresIsUnsafeFromEveryHeight) {
  for (const double z_m : {8.0, 15.0, 30.0}) {
    const PinholeIntrinsics k = camera_of(352, 352);
    cv::Mat depth = level_ground(k, z_m);
    scenes::change(
        depth, k, z_m, [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 0.3; },
        static_cast<float>(z_m - 0.3));
    const SiteSelection selection = SiteSelector(derivatives(), k).select(depth, kDown);
    EXPECT_EQ(selection.safe.at<std::uint8_t>(176, 176), 0) << z_m;
    ASSERT_TRUE(selection.largest);
    const LandingSite& site = *selection.largest;
    const double dx = std::max(0.0, std::abs(site.p_level.x()) - 0.3);
    const double dy = std::max(0.0, std::abs(site.p_level.y()) - 0.3);
    EXPECT_GT(std::hypot(dx, dy), site.radius_m) << "the circle touches the box from " << z_m << " m";
  }
}

TEST(DerivativeJudge, ThinPoleIsUnsafe) {
  const PinholeIntrinsics k = camera_of(352, 352);
  cv::Mat depth = level_ground(k, 20);
  depth.at<float>(150, 190) = 17;  // one pixel, 4.5 cm wide, 3 m tall
  const SiteSelection selection = SiteSelector(derivatives(), k).select(depth, kDown);
  EXPECT_EQ(selection.safe.at<std::uint8_t>(150, 190), 0);
  ASSERT_TRUE(selection.largest);
  const double distance_px = (selection.largest->centre_px - Eigen::Vector2d(190, 150)).norm();
  EXPECT_GT(distance_px, selection.largest->radius_px);
}

TEST(DerivativeJudge, NoisyLevelGroundIsStillASite) {
  for (const double z_m : {8.0, 15.0, 30.0}) {
    const PinholeIntrinsics k = camera_of(352, 352);
    const SiteSelection selection =
        SiteSelector(derivatives(), k).select(scenes::with_noise(level_ground(k, z_m), 0.02, 11), kDown);
    EXPECT_TRUE(selection.found()) << z_m << " m: " << describe(selection);
    EXPECT_GT(cv::countNonZero(selection.safe), 0.99 * cv::countNonZero(selection.terrain.known));
  }
}

TEST(DerivativeJudge, ReasonsAreSaid) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const SiteSelector selector(derivatives(), k);
  const SiteSelection nothing = selector.select(cv::Mat::zeros(352, 352, CV_32FC1), kDown);
  EXPECT_EQ(nothing.status, SiteStatus::kNoDepth);
  EXPECT_EQ(describe(nothing), "no depth");
  EXPECT_FALSE(nothing.largest);

  const SiteSelection steep = selector.select(scenes::plane(k, 20, 0.5, 0), kDown);
  EXPECT_EQ(steep.status, SiteStatus::kNoFlatArea);
  EXPECT_EQ(describe(steep), "no flat area");

  const SiteSelection small = selector.select(level_ground(k, 5), kDown);  // 4 m wide: 1.5 m remain
  EXPECT_EQ(small.status, SiteStatus::kTooSmall);
  EXPECT_EQ(describe(small), "largest circle 1.5 m");
  EXPECT_FALSE(small.found());
  EXPECT_TRUE(small.largest);

  EXPECT_EQ(describe(selector.select(level_ground(k, 15), kDown)), "landing site of 5.4 m");
}

TEST(DerivativeJudge, MarginAndErosionTakeTheirPart) {
  const PinholeIntrinsics k = camera_of(352, 352);
  SiteSelectionConfig config = derivatives();
  const double plain_m = SiteSelector(config, k).select(level_ground(k, 20), kDown).largest->radius_m;
  config.rules.margin_m = 0.7;
  EXPECT_NEAR(SiteSelector(config, k).select(level_ground(k, 20), kDown).largest->radius_m, plain_m - 0.7,
              1e-4);
  config.rules.margin_m = 0;
  config.derivatives.erode_px = 23;
  config.derivatives.dilate_px = 3;
  cv::Mat boxed = level_ground(k, 20);
  boxed(cv::Rect(100, 100, 30, 30)).setTo(15);
  const SiteSelector inflating(config, k);
  const SiteSelection inflated = inflating.select(boxed, kDown);
  config.derivatives.erode_px = 3;
  const SiteSelection opened = SiteSelector(config, k).select(boxed, kDown);
  cv::Mat lost = opened.safe & ~inflated.safe;
  EXPECT_GT(cv::countNonZero(lost), 0);
  EXPECT_EQ(cv::countNonZero(inflated.safe & ~opened.safe), 0);
}

TEST(DerivativeJudge, NothingThatWasUnsafeBecomesSafeByOpening) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const cv::Mat depth = scenes::with_noise(level_ground(k, 30), 0.06, 5);
  SiteSelectionConfig config = derivatives();
  const SiteSelection opened = SiteSelector(config, k).select(depth, kDown);
  config.derivatives.erode_px = config.derivatives.dilate_px = 1;
  const SiteSelection raw = SiteSelector(config, k).select(depth, kDown);
  EXPECT_EQ(cv::countNonZero(opened.safe & ~raw.safe), 0);
}

TEST(DerivativeJudge, CircleAtAPixel) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const SiteSelector selector(derivatives(), k);
  const SiteSelection selection = selector.select(level_ground(k, 20), kDown);
  const auto centre = circle_at(selection, k, {175.5, 175.5});
  ASSERT_TRUE(centre);
  EXPECT_NEAR(centre->radius_m, selection.largest->radius_m, 0.1);
  const auto aside = circle_at(selection, k, {80, 175});
  ASSERT_TRUE(aside);
  EXPECT_LT(aside->radius_m, centre->radius_m);
  EXPECT_FALSE(circle_at(selection, k, {2, 2}));
  EXPECT_FALSE(circle_at(selection, k, {-20, 100}));
  EXPECT_FALSE(circle_at(selection, k, {400, 100}));
  EXPECT_FALSE(circle_at(selection, k, {std::nan(""), 100}));
}

TEST(DerivativeJudge, HazardsAreRefusedBecauseThereIsNoRasterForThem) {
  const PinholeIntrinsics k = camera_of(352, 352);
  const SiteSelector selector(derivatives(), k);
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = kDown;
  const SiteSelection seen = selector.look(level_ground(k, 20), T_world_camera);
  EXPECT_TRUE(seen.ground.empty());
  EXPECT_EQ(seen.status, SiteStatus::kNoDepth);
  EXPECT_THROW(selector.decide(seen, cv::Mat::zeros(352, 352, CV_8UC1), T_world_camera),
               std::invalid_argument);
  EXPECT_TRUE(selector.decide(seen, {}, T_world_camera).found());
}

TEST(DerivativeJudge, GroundBelowAWireIsUnsafe) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = level_ground(k, 20);
  depth.col(276).setTo(
      10);  // a wire 2.27 m right of the camera and 10 m up is seen where the ground is 4.55 m right
  SiteSelectionConfig config = derivatives();
  const SiteSelection warned = SiteSelector(config, k).select(depth, kDown);
  config.derivatives.overhang_clearance_m = 0;
  const SiteSelection paper = SiteSelector(config, k).select(depth, kDown);
  EXPECT_EQ(warned.safe.at<std::uint8_t>(176, 226), 0);
  EXPECT_EQ(paper.safe.at<std::uint8_t>(176, 226), 255);
  ASSERT_TRUE(warned.largest);
  const double wire_x_m = 100.0 / 440 * 10;
  EXPECT_GT(std::abs(warned.largest->p_level.x() - wire_x_m), warned.largest->radius_m);
  EXPECT_LT(std::abs(paper.largest->p_level.x() - wire_x_m), paper.largest->radius_m);
}

TEST(DerivativeJudge, WeakSpecksAreNoiseAndStrongOrLongOnesAreNot) {
  const PinholeIntrinsics k = camera_of(353, 353);
  const auto safe_at_centre = [&](int width_px, int height_px, double bump_m) {
    cv::Mat depth = level_ground(k, 20);  // 4.5 cm a pixel
    depth(cv::Rect(176 - width_px / 2, 176 - height_px / 2, width_px, height_px)).setTo(20 - bump_m);
    return SiteSelector(derivatives(), k).select(depth, kDown).safe.at<std::uint8_t>(176, 176) != 0;
  };
  EXPECT_TRUE(safe_at_centre(5, 5, 0.04)) << "below the limit";
  EXPECT_TRUE(safe_at_centre(5, 5, 0.06)) << "a weak speck";
  EXPECT_FALSE(safe_at_centre(5, 5, 0.20)) << "a stone";
  EXPECT_FALSE(safe_at_centre(5, 200, 0.06)) << "a kerb";
}

}  // namespace
}  // namespace alight
