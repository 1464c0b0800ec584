#include "train/evaluation/scores/depth_check.hpp"

#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alight {
namespace {

using ::testing::HasSubstr;
constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr double kDepth_m = 8;  // a disparity of 5 px

/// f = 400 px, baseline 0.1 m, no IMU; a LiDAR along the optical axis if asked for.
Rig stereo_rig(bool with_lidar) {
  Rig rig;
  rig.cam0.camera.intrinsics = {400, 400, 79.5, 59.5, kWidth, kHeight};
  rig.cam1 = rig.cam0;
  rig.T_cam1_cam0.translation().x() = -0.1;
  if (with_lidar) {
    rig.lidar0.emplace();
    rig.lidar0->T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  }
  return rig;
}

cv::Mat level(double depth_m) { return cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(depth_m)); }

/// A textured wall at kDepth_m.
DepthCheckInput wall(double guessed_m) {
  cv::Mat texture(kHeight, kWidth + 5, CV_8UC1);
  cv::RNG random(7);
  random.fill(texture, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(texture, texture, {3, 3}, 0);
  DepthCheckInput input;
  input.left = texture.colRange(0, kWidth).clone();
  input.right = texture.colRange(5, kWidth + 5).clone();
  input.depth_m = level(guessed_m);
  return input;
}

std::string check_mistake(const DepthCheckInput& input, const Rig& rig) {
  try {
    check_depth(input, rig, {});
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

TEST(DepthCheck, TrueDepthIsAcceptedAndWrongDepthIsNot) {
  const DepthCheckResult right = check_depth(wall(kDepth_m), stereo_rig(false), {});
  EXPECT_GT(*right.scores.sim_pred, 0.98);
  EXPECT_LT(*right.scores.sim, 0.5);
  EXPECT_FALSE(right.scores.sim_d);
  EXPECT_EQ(right.verdict, Verdict::kAccept);
  const DepthCheckResult wrong = check_depth(wall(2 * kDepth_m), stereo_rig(false), {});
  EXPECT_LT(*wrong.scores.sim_pred, 0.5);
  EXPECT_NE(wrong.verdict, Verdict::kAccept);
}

TEST(DepthCheck, SimDIsThatOfTheLidarsDepth) {
  DepthCheckInput input = wall(2 * kDepth_m);
  input.sparse_m = level(0);
  for (int v = 0; v < kHeight; v += 6) {
    for (int u = 0; u < kWidth; u += 6) input.sparse_m.at<float>(v, u) = kDepth_m;
  }
  const DepthCheckResult result = check_depth(input, stereo_rig(false), {});
  EXPECT_GT(*result.scores.sim_d, 0.98);
  EXPECT_EQ(result.verdict, Verdict::kReject);
}

/// A narrow LiDAR is filled inside its field of view, a rig without one everywhere.
TEST(DepthCheck, ARigWithoutLidarFillsTheWholeImage) {
  DepthCheckInput input = wall(kDepth_m);
  input.sparse_m = level(kDepth_m);
  DepthCheckConfig config;
  config.lidar_half_fov_deg = 5;  // 35 px
  const double whole = check_depth(input, stereo_rig(false), config).scores.share;
  const double inside = check_depth(input, stereo_rig(true), config).scores.share;
  EXPECT_GT(whole, 0.9);
  EXPECT_LT(inside, 0.25);
}

TEST(DepthCheck, ErrorsAreAgainstTheTruth) {
  DepthCheckInput input = wall(kDepth_m);
  input.truth_m = level(10);
  input.depth_m.row(0).setTo(0);
  const DepthCheckResult result = check_depth(input, stereo_rig(false), {});
  EXPECT_NEAR(result.errors->value(Metric::kMae), 2000, 1e-3);
  EXPECT_NEAR(result.errors->value(Metric::kRel), 200, 1e-3);
  EXPECT_EQ(result.errors->unknown(), kWidth);
  const std::string page = format_check(result);
  EXPECT_THAT(page, HasSubstr("\nsim_pred   1.0000  "));
  EXPECT_THAT(page, HasSubstr("\nshare      0."));
  EXPECT_THAT(page, HasSubstr("\nverdict    accept\n"));
  EXPECT_THAT(page, HasSubstr("MAE [mm]           2000.00\n"));
  EXPECT_THAT(page, HasSubstr("19040, 160 more have no depth\n"));
}

TEST(DepthCheck, CentresOfTheRigsImagesAreWelcomeWhenSaidSo) {
  DepthCheckInput input = wall(kDepth_m);
  const cv::Rect centre(40, 30, 80, 60);
  for (cv::Mat* map : {&input.left, &input.right, &input.depth_m}) *map = (*map)(centre).clone();
  EXPECT_THAT(check_mistake(input, stereo_rig(false)),
              HasSubstr("80x60 pixels, the rig's cameras have 160x120"));
  DepthCheckConfig config;
  config.centre_cropped = true;
  EXPECT_EQ(check_depth(input, stereo_rig(false), config).verdict, Verdict::kAccept);
}

TEST(DepthCheck, MapsThatDoNotFitAreNamed) {
  DepthCheckInput input = wall(kDepth_m);
  input.truth_m = cv::Mat::ones(kHeight, kWidth - 1, CV_32FC1);
  EXPECT_THAT(check_mistake(input, stereo_rig(false)), HasSubstr("the true depth map has 159x120 pixels"));
  Rig mono = stereo_rig(false);
  mono.cam1.reset();
  EXPECT_THAT(check_mistake(wall(kDepth_m), mono), HasSubstr("no cam1"));
}

}  // namespace
}  // namespace alight
