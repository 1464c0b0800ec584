#include "infer/depth/self_evaluation.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "infer/depth/image_ssim.hpp"
#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

using fakes::LevelWorld;

RectifiedRig rig_of(const StereoFrame& frame) {
  RectifiedRig rig;
  rig.intrinsics = {
      220, 220, (frame.left.cols - 1) / 2.0, (frame.left.rows - 1) / 2.0, frame.left.cols, frame.left.rows};
  rig.baseline_m = 0.08;
  return rig;
}
cv::Mat flat(const StereoFrame& frame, double depth_m) {
  return {frame.left.size(), CV_32FC1, cv::Scalar(depth_m)};
}

TEST(Ssim, IsOneOfItselfAndMatchesTheFormulaOnOneWindow) {
  cv::Mat a(9, 7, CV_32FC1);
  cv::Mat b(9, 7, CV_32FC1);
  cv::RNG random(5);
  random.fill(a, cv::RNG::UNIFORM, 0, 1);
  random.fill(b, cv::RNG::UNIFORM, 0, 1);
  double min = 0;
  double max = 0;
  cv::minMaxLoc(ssim_map(a, a), &min, &max);
  EXPECT_NEAR(min, 1, 1e-5);
  EXPECT_NEAR(max, 1, 1e-5);
  double ma = 0, mb = 0, maa = 0, mbb = 0, mab = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const double x = static_cast<double>(a.at<float>(4 + dv, 3 + du));
      const double y = static_cast<double>(b.at<float>(4 + dv, 3 + du));
      ma += x / 9, mb += y / 9, maa += x * x / 9, mbb += y * y / 9, mab += x * y / 9;
    }
  }
  const double c1 = 1e-4, c2 = 9e-4;
  const double expected = (2 * ma * mb + c1) * (2 * (mab - ma * mb) + c2) /
                          ((ma * ma + mb * mb + c1) * (maa - ma * ma + mbb - mb * mb + c2));
  EXPECT_NEAR(static_cast<double>(ssim_map(a, b).at<float>(4, 3)), expected, 1e-5);
  EXPECT_THROW(to_luminance(a), std::invalid_argument);
}

/// Scores as the engine makes them, probe included.
StereoScores probed(const StereoTest& test, const cv::Mat& depth_m, const RightView* lidar) {
  const RightView view = test.reconstruct(depth_m);
  StereoScores scores = test.score(view, lidar);
  scores.peak = test.peak(depth_m, view, StereoTestConfig{}.probe);
  return scores;
}

TEST(StereoTest, TrueDepthScoresHighAndWrongDepthIsRejected) {
  for (const double height_m : {3.0, 6.0, 9.0}) {  // disparities of 5.9, 2.9 and 2.0 px
    const LevelWorld world(height_m);
    const StereoFrame frame = world.frame(0);
    const StereoTest test(frame.left, frame.right, rig_of(frame));
    const RightView truth = test.reconstruct(flat(frame, height_m));
    const StereoScores right = probed(test, flat(frame, height_m), &truth);
    EXPECT_GT(*right.sim_pred, 0.9) << height_m;
    EXPECT_LT(*right.sim, 0.5) << height_m;
    EXPECT_EQ(judge(right, {}), Verdict::kAccept) << height_m;
    for (const double factor : {1.3, 0.75, 1.6, 3.0}) {
      for (const RightView* lidar : {&truth, static_cast<const RightView*>(nullptr)}) {
        const StereoScores wrong = probed(test, flat(frame, height_m * factor), lidar);
        EXPECT_LT(*wrong.sim_pred, *right.sim_pred - 0.1) << height_m << " x" << factor;
        EXPECT_EQ(judge(wrong, {}), Verdict::kReject) << height_m << " x" << factor;
      }
    }
  }
}

TEST(StereoTest, PapersRulesAlonePassWhatTheProbeRejects) {
  const LevelWorld world(6);
  const StereoFrame frame = world.frame(0);
  const StereoTest test(frame.left, frame.right, rig_of(frame));
  const RightView truth = test.reconstruct(flat(frame, 6));
  StereoScores wrong = probed(test, flat(frame, 6 * 1.3), &truth);
  EXPECT_EQ(judge(wrong, {}), Verdict::kReject);
  wrong.peak.reset();
  EXPECT_EQ(judge(wrong, {}), Verdict::kAccept);
}

TEST(StereoTest, DepthThatIsWrongInPartScoresLower) {
  const LevelWorld world(6);
  const StereoFrame frame = world.frame(0);
  const StereoTest test(frame.left, frame.right, rig_of(frame));
  const RightView truth = test.reconstruct(flat(frame, 6));
  double before = *test.score(truth, &truth).sim_pred;
  for (const int wrong_columns : {40, 80, 120}) {
    cv::Mat part = flat(frame, 6);
    part.colRange(0, wrong_columns).setTo(4.0);
    const double now = *test.score(test.reconstruct(part), &truth).sim_pred;
    EXPECT_LT(now, before - 0.1);
    before = now;
  }
}

TEST(StereoTest, AllScoresAreOverTheSamePixels) {
  const LevelWorld world(6);
  const StereoFrame frame = world.frame(0);
  const StereoTest test(frame.left, frame.right, rig_of(frame));
  cv::Mat part = flat(frame, 6);
  part.colRange(0, 100).setTo(0);  // LiDAR knows the right side only
  const RightView lidar = test.reconstruct(part);
  const RightView full = test.reconstruct(flat(frame, 6));
  const StereoScores scores = test.score(full, &lidar);
  // The same depth over the same pixels is the same number, to the last bit.
  EXPECT_EQ(*scores.sim_pred, *scores.sim_d);
  EXPECT_EQ(test.score(lidar, &full).share, scores.share);
  EXPECT_EQ(*test.score(lidar, &full).sim, *scores.sim);
  EXPECT_LT(scores.share, test.score(full, nullptr).share);
}

TEST(StereoTest, WithoutLidarOnlyTheSecondRuleAccepts) {
  StereoScores scores;
  scores.share = 0.5;
  scores.sim = 0.4;
  scores.sim_pred = 0.55;
  EXPECT_EQ(judge(scores, {}), Verdict::kReject);
  scores.sim_pred = 0.61;
  EXPECT_EQ(judge(scores, {}), Verdict::kAccept);
  scores.sim_pred = 0.55;
  scores.sim_d = 0.6;
  EXPECT_EQ(judge(scores, {}), Verdict::kAccept);
  scores.sim_d = 0.71;
  EXPECT_EQ(judge(scores, {}), Verdict::kReject);
}

TEST(StereoTest, AbstainsWhereStereoSaysNothing) {
  const LevelWorld world(300);  // disparity 0.06 px
  const StereoFrame frame = world.frame(0);
  const StereoTest test(frame.left, frame.right, rig_of(frame));
  const RightView truth = test.reconstruct(flat(frame, 300));
  const StereoScores scores = test.score(test.reconstruct(flat(frame, 200)), &truth);
  EXPECT_EQ(judge(scores, {}), Verdict::kNoEvidence);
  StereoTestConfig paper;
  paper.min_contrast = 0;
  EXPECT_NE(judge(scores, paper), Verdict::kNoEvidence);
}

TEST(StereoTest, NoOverlapAndMonoGiveNoNumbers) {
  const LevelWorld world(6);
  const StereoFrame frame = world.frame(0);
  const StereoTest test(frame.left, frame.right, rig_of(frame));
  const RightView unknown = test.reconstruct(flat(frame, 0));
  const RightView beyond = test.reconstruct(flat(frame, 0.05));  // disparity wider than the image
  for (const RightView* view : {&unknown, &beyond}) {
    const StereoScores scores = test.score(*view, nullptr);
    EXPECT_FALSE(scores.sim || scores.sim_pred || scores.sim_d);
    EXPECT_EQ(scores.share, 0);
    EXPECT_EQ(judge(scores, {}), Verdict::kNoEvidence);
  }
  const StereoTest mono(frame.left, {}, rig_of(frame));
  EXPECT_FALSE(mono.has_right());
  EXPECT_EQ(judge(mono.score(unknown, nullptr), {}), Verdict::kNoEvidence);
}

TEST(StereoTest, NothingIsNanOnBlackImages) {
  const cv::Mat black = cv::Mat::zeros(40, 60, CV_8UC1);
  RectifiedRig rig;
  rig.intrinsics = {220, 220, 29.5, 19.5, 60, 40};
  rig.baseline_m = 0.08;
  const StereoTest test(black, black, rig);
  const StereoScores scores = test.score(test.reconstruct(cv::Mat(40, 60, CV_32FC1, cv::Scalar(8))), nullptr);
  EXPECT_EQ(*scores.sim, 1);
  EXPECT_EQ(*scores.sim_pred, 1);
}

TEST(Holdout, ErrorsAreExactAndFedPixelsDoNotCount) {
  const cv::Mat prediction(10, 10, CV_32FC1, cv::Scalar(10.5));
  cv::Mat holdout = cv::Mat::zeros(10, 10, CV_32FC1);
  cv::Mat fed = cv::Mat::zeros(10, 10, CV_32FC1);
  holdout.row(2).setTo(10);
  holdout.row(3).setTo(21);
  holdout.row(4).setTo(10);
  fed.row(3).setTo(21);
  holdout.at<float>(4, 0) = 15;  // one edge
  const HoldoutScores scores = compare_with_holdout(prediction, holdout, fed);
  EXPECT_EQ(scores.points, 20);
  EXPECT_NEAR(scores.median_m, 0.5, 1e-6);
  EXPECT_NEAR(scores.median_relative, 0.05, 1e-6);
  EXPECT_NEAR(scores.rms_m, std::sqrt((19 * 0.25 + 4.5 * 4.5) / 20), 1e-6);
  EXPECT_NEAR(scores.rms_relative, std::sqrt((19 * 0.0025 + 0.09) / 20), 1e-6);
}

TEST(Holdout, UnknownPredictionIsWhollyWrongAndFewPointsSayNothing) {
  cv::Mat prediction = cv::Mat::zeros(10, 10, CV_32FC1);
  prediction.at<float>(0, 0) = std::nanf("");
  const cv::Mat holdout(10, 10, CV_32FC1, cv::Scalar(10));
  const HoldoutScores scores = compare_with_holdout(prediction, holdout, cv::Mat::zeros(10, 10, CV_32FC1));
  EXPECT_EQ(scores.points, 100);
  EXPECT_EQ(scores.median_relative, 1);
  EXPECT_EQ(scores.rms_relative, 1);
  EXPECT_EQ(judge(scores, {}), Verdict::kReject);
  EXPECT_EQ(judge(HoldoutScores{99, 0, 0, 0, 0}, {}), Verdict::kNoEvidence);
  EXPECT_EQ(judge(HoldoutScores{100, 0, 0, 0.004, 0.015}, {}), Verdict::kAccept);
  EXPECT_EQ(judge(HoldoutScores{100, 0, 0, 0.0041, 0.015}, {}), Verdict::kReject);
  EXPECT_EQ(judge(HoldoutScores{100, 0, 0, 0.004, 0.016}, {}), Verdict::kReject);
  EXPECT_EQ(compare_with_holdout(prediction, cv::Mat::zeros(10, 10, CV_32FC1), prediction).points, 0);
}

TEST(Decide, ConfigurationDecides) {
  constexpr Verdict kYes = Verdict::kAccept, kNo = Verdict::kReject, kMaybe = Verdict::kNoEvidence;
  EXPECT_EQ(decide(kYes, kNo, false, DecideBy::kStereo), kYes);
  EXPECT_EQ(decide(kYes, kNo, false, DecideBy::kLidarHoldout), kNo);
  EXPECT_EQ(decide(kYes, kNo, false, DecideBy::kEither), kYes);
  EXPECT_EQ(decide(kMaybe, kNo, false, DecideBy::kEither), kNo);
  EXPECT_EQ(decide(kYes, kNo, false, DecideBy::kBoth), kNo);
  EXPECT_EQ(decide(kNo, kYes, false, DecideBy::kBoth), kNo);
  EXPECT_EQ(decide(kYes, kYes, false, DecideBy::kBoth), kYes);
  EXPECT_EQ(decide(kMaybe, kYes, false, DecideBy::kBoth), kYes) << "too high for stereo";
  EXPECT_EQ(decide(kYes, kMaybe, false, DecideBy::kBoth), kMaybe) << "the LiDAR's word is still to come";
  EXPECT_EQ(decide(kYes, kMaybe, true, DecideBy::kBoth), kYes) << "no LiDAR: stereo alone";
  EXPECT_EQ(decide(kMaybe, kMaybe, true, DecideBy::kBoth), kMaybe);
}

}  // namespace
}  // namespace alight
