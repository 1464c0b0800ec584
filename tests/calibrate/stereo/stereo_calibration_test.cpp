#include "calibrate/stereo/stereo_calibration.hpp"

#include <cstdio>
#include <filesystem>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibrate/board/chessboard.hpp"
#include "calibrate/stereo/stereo_bundle.hpp"
#include "calibrate/stereo/stereo_report.hpp"
#include "calibrate/stereo/stereo_views.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kRealSet = "/usr/share/doc/opencv-doc/examples/data";  // Debian's opencv-doc
const Chessboard kBoard{9, 6, 0.025};

std::vector<StereoView> real_views() {
  std::vector<StereoView> views;
  for (int i = 1; i <= 14; ++i) {
    char number[8];
    std::snprintf(number, sizeof(number), "%02d.jpg", i);
    StereoView view;
    view.name = number;
    view.left = cv::imread(std::string(kRealSet) + "/left" + number, cv::IMREAD_GRAYSCALE);
    view.right = cv::imread(std::string(kRealSet) + "/right" + number, cv::IMREAD_GRAYSCALE);
    if (!view.left.empty() && !view.right.empty()) views.push_back(view);  // there is no 10
  }
  return views;
}

TEST(StereoCalibration, RealChessboardsAsGoodAsOpenCv) {
  std::vector<StereoView> views = real_views();
  if (views.empty()) GTEST_SKIP() << "opencv-doc is not installed";
  find_boards(kBoard, views, 2);
  const StereoCalibration result = calibrate_stereo(kBoard, views, {});
  std::vector<Corners> left;
  std::vector<Corners> right;
  for (const StereoView& view : result.views) {
    EXPECT_TRUE(view.used || !view.reason.empty()) << view.name;
    if (!view.used) continue;
    left.push_back(view.left_corners);
    right.push_back(view.right_corners);
  }
  ASSERT_GE(left.size(), 12u);
  const std::vector<std::vector<cv::Point3f>> points(left.size(), kBoard.corner_points());
  const cv::Size size(640, 480);
  cv::Mat K1, D1, K2, D2, R, T, E, F;
  std::vector<cv::Mat> unused;
  cv::calibrateCamera(points, left, size, K1, D1, unused, unused);
  cv::calibrateCamera(points, right, size, K2, D2, unused, unused);
  const double opencv_rms_px = cv::stereoCalibrate(
      points, left, right, K1, D1, K2, D2, size, R, T, E, F, cv::CALIB_USE_INTRINSIC_GUESS,
      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 1e-6});
  std::printf("RMS %.4f px, cv::stereoCalibrate %.4f px, %zu views\n", result.rms_px, opencv_rms_px,
              left.size());
  EXPECT_LE(result.rms_px, 0.25);
  EXPECT_LE(result.rms_px, 1.05 * opencv_rms_px);
  EXPECT_GE(result.rms_px, 0.95 * opencv_rms_px);
  EXPECT_LT(result.epipolar_rms_px, 0.25);
}

/// Two fisheyes 0.1 m apart, slightly turned against each other.
StereoBundle fisheyes() {
  StereoBundle truth;
  truth.left.intrinsics = {300, 302, 318, 242, 640, 480};
  truth.left.distortion_model = DistortionModel::kEquidistant;
  truth.left.distortion_coeffs = {0.02, -0.01, 0.004, -0.001};
  truth.right = truth.left;
  truth.right.intrinsics = {297, 298, 322, 238, 640, 480};
  truth.right.distortion_coeffs = {0.015, -0.006, 0.001, 0.0005};
  truth.T_right_left.translate(Eigen::Vector3d(-0.1, 0.001, -0.002));
  truth.T_right_left.rotate(Eigen::AngleAxisd(0.01, Eigen::Vector3d(0.3, 0.9, 0.3).normalized()));
  return truth;
}

/// Their corners of boards all over the image, 0.1 px of noise.
std::vector<StereoView> fisheye_views(const StereoBundle& truth, unsigned seed = 17) {
  cv::RNG random(seed);
  std::vector<StereoView> views;
  for (int i = 0; i < 24; ++i) {
    Eigen::Isometry3d T(
        Eigen::Translation3d(0.18 * (i % 4 - 1.5), 0.13 * (i / 4 % 3 - 1), 0.3 + 0.04 * (i % 3)));
    T.rotate(Eigen::AngleAxisd(random.uniform(-0.6, 0.6), Eigen::Vector3d::UnitX()));
    T.rotate(Eigen::AngleAxisd(random.uniform(-0.6, 0.6), Eigen::Vector3d::UnitY()));
    T = T * Eigen::Translation3d(-kBoard.centre());
    StereoView view;
    view.name = std::to_string(i);
    view.left = view.right = cv::Mat::zeros(480, 640, CV_8UC1);
    view.left_corners = project_board(kBoard, truth.left, T);
    view.right_corners = project_board(kBoard, truth.right, truth.T_right_left * T);
    for (Corners* corners : {&view.left_corners, &view.right_corners}) {
      for (cv::Point2f& corner : *corners)
        corner +=
            cv::Point2f(static_cast<float>(random.gaussian(0.1)), static_cast<float>(random.gaussian(0.1)));
    }
    views.push_back(view);
  }
  return views;
}

TEST(StereoCalibration, FindsEquidistantLensesWithinTheirStandardDeviations) {
  const StereoBundle truth = fisheyes();
  StereoCalibrationConfig config;
  config.model = DistortionModel::kEquidistant;
  const StereoCalibration result = calibrate_stereo(kBoard, fisheye_views(truth), config);
  EXPECT_NEAR(result.rms_px, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_EQ(result.rig.cam0.camera.distortion_model, DistortionModel::kEquidistant);
  std::vector<double> expected;
  for (const Camera* camera : {&truth.left, &truth.right}) {
    const PinholeIntrinsics& k = camera->intrinsics;
    expected.insert(expected.end(), {k.fx_px, k.fy_px, k.cx_px, k.cy_px});
    expected.insert(expected.end(), camera->distortion_coeffs.begin(), camera->distortion_coeffs.end());
  }
  ASSERT_GE(result.estimates.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Estimate& e = result.estimates[i];
    EXPECT_LT(std::abs(e.value - expected[i]), 4 * e.sigma) << e.name;
    EXPECT_GT(e.sigma, 0) << e.name;
  }
  const Eigen::Isometry3d off = truth.T_right_left.inverse() * result.rig.T_cam1_cam0;
  EXPECT_LT(off.translation().norm(), 5e-4);
  EXPECT_LT(to_degrees(Eigen::AngleAxisd(off.linear()).angle()), 0.1);
  EXPECT_LT(result.epipolar_rms_px, 0.25);
}

// Undamped steps (cv::fisheye::calibrate) diverge on one such set in eight, another one for each order of sums.
TEST(StereoCalibration, FindsEquidistantLensesWhateverLensAndNoise) {
  StereoCalibrationConfig config;
  config.model = DistortionModel::kEquidistant;
  cv::RNG random(5);
  for (unsigned seed = 1; seed <= 16; ++seed) {
    StereoBundle truth = fisheyes();
    for (Camera* camera : {&truth.left, &truth.right}) {
      camera->intrinsics.fx_px = camera->intrinsics.fy_px = random.uniform(180.0, 400.0);
      camera->intrinsics.cx_px += random.uniform(-25.0, 25.0);
      camera->distortion_coeffs[0] += random.uniform(-0.05, 0.05);
    }
    const StereoCalibration result = calibrate_stereo(kBoard, fisheye_views(truth, seed), config);
    EXPECT_NEAR(result.rms_px, 0.1 * std::sqrt(2.0), 0.02) << seed;
    EXPECT_NEAR(result.rig.cam0.camera.intrinsics.fx_px, truth.left.intrinsics.fx_px, 3) << seed;
  }
}

TEST(StereoCalibration, LeavesOutAViewThatFitsFarWorseAndSaysSo) {
  std::vector<StereoView> views = fisheye_views(fisheyes());
  for (cv::Point2f& corner : views[5].right_corners)
    corner.x += 3;  // the board moved between the cameras' exposures
  StereoCalibrationConfig config;
  config.model = DistortionModel::kEquidistant;
  const StereoCalibration result = calibrate_stereo(kBoard, views, config);
  EXPECT_FALSE(result.views[5].used);
  EXPECT_THAT(format_stereo_report(result), HasSubstr("5 left out: fits with"));
}

// A board that faces the camera looks alike from near and through a long lens. All numbers are exact in binary.
TEST(StereoCalibration, RefusesViewsThatLeaveTheFocalLengthFree) {
  const Chessboard board{9, 6, 0.0625};
  StereoBundle facing;
  facing.left.intrinsics = facing.right.intrinsics = {256, 256, 320, 240, 640, 480};
  facing.T_right_left.translation() = Eigen::Vector3d(-0.125, 0, 0);
  facing.T_left_board = {Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1))};
  const Corners left = project_board(board, facing.left, facing.T_left_board[0]);
  const Corners right = project_board(board, facing.right, facing.T_right_left * facing.T_left_board[0]);
  try {
    refine_stereo(board, {{&left, &right}}, facing);
    FAIL() << "nothing was thrown";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("the views do not fix the cameras: record the board tilted"));
  }
}

TEST(StereoCalibration, RefusesMixedResolutions) {
  std::vector<StereoView> views(2);
  views[0].left = views[0].right = views[1].left = cv::Mat::zeros(48, 64, CV_8UC1);
  views[1].right = cv::Mat::zeros(40, 64, CV_8UC1);
  views[1].name = "second";
  try {
    find_boards(kBoard, views, 1);
    FAIL() << "nothing was thrown";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("second: the right image has 64x40 pixels, the first view's 64x48"));
  }
}

TEST(StereoCalibration, NamesViewsWithoutABoard) {
  std::vector<StereoView> views(6);
  for (StereoView& view : views) view.left = view.right = cv::Mat::zeros(96, 128, CV_8UC1);
  views[4].name = "fifth";
  find_boards(kBoard, views, 2);
  try {
    calibrate_stereo(kBoard, views, {});
    FAIL() << "nothing was thrown";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("only 0 of 6 views are usable"));
    EXPECT_THAT(e.what(), HasSubstr("fifth: both cameras: no chessboard of 9x6 inner corners found"));
  }
}

TEST(StereoCalibration, NamesTheCameraThatSeesNoBoard) {
  std::vector<StereoView> views = real_views();
  if (views.empty()) GTEST_SKIP() << "opencv-doc is not installed";
  views.resize(2);
  for (StereoView& view : views)
    view.left = cv::Mat(view.left.size(), CV_8UC1, cv::Scalar(90));  // a cap on the lens
  find_boards(kBoard, views, 2);
  try {
    calibrate_stereo(kBoard, views, {});
    FAIL() << "nothing was thrown";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr("only 0 of 2 views are usable"));
    EXPECT_THAT(e.what(), HasSubstr("01.jpg: left: no chessboard of 9x6 inner corners found"));
  }
}

TEST(Chessboard, SizesAreCheckedAtTheCommandLine) {
  EXPECT_EQ(parse_chessboard("9x6", 0.025).columns, 9);
  for (const char* wrong : {"9", "9x", "2x6", "9x6x2", "axb", ""})
    EXPECT_THROW(parse_chessboard(wrong, 0.025), ConfigError);
  EXPECT_THROW(parse_chessboard("9x6", 0), ConfigError);
}

TEST(Chessboard, TurnsMapTheGridToItself) {
  EXPECT_EQ(board_turns({9, 6, 0.025}).size(), 2u);
  EXPECT_EQ(board_turns({5, 5, 0.025}).size(), 4u);
  const Eigen::Isometry3d half = board_turns({9, 6, 0.025})[1];
  const Chessboard board{9, 6, 0.025};
  EXPECT_TRUE((half * board.corner(0)).isApprox(board.corner(board.corners() - 1), 1e-12));
}

}  // namespace
}  // namespace alight
