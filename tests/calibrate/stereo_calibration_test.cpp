#include "calibrate/stereo_calibration.hpp"

#include <filesystem>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibrate/chessboard.hpp"
#include "configs/errors.hpp"

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
    EXPECT_THAT(e.what(), HasSubstr("fifth: both eyes: no chessboard of 9x6 inner corners found"));
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
