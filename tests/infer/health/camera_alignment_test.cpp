#include "infer/health/camera_alignment.hpp"

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kDistance_m = 16;
constexpr double kDisparity_px = 440 * 0.08 / kDistance_m;

RectifiedRig rig() {
  RectifiedRig rig;
  rig.intrinsics = {440, 440, 159.5, 119.5, 320, 240};
  rig.baseline_m = 0.08;
  return rig;
}

/// The same ground, seen `x_px`, `y_px` further.
cv::Mat view(double x_px, double y_px) {
  cv::Mat ground(320, 400, CV_8UC1);
  cv::RNG random(5);
  random.fill(ground, cv::RNG::UNIFORM, 20, 236);
  cv::GaussianBlur(ground, ground, {9, 9}, 2);
  const cv::Matx23d move(1, 0, 40 + x_px, 0, 1, 40 + y_px);
  cv::Mat image;
  cv::warpAffine(ground, image, move, {320, 240}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  return image;
}

std::string fault_of(const cv::Mat& left, const cv::Mat& right, double distance_m = kDistance_m) {
  CameraAlignment alignment({}, rig());
  for (int i = 0; i < 3; ++i) alignment.add(to_nanoseconds(0.1 * i), left, right, distance_m);
  std::vector<HealthFinding> findings;
  alignment.report(findings);
  EXPECT_EQ(alignment.usable(), findings.empty());
  return findings.empty() ? "" : findings.front().fault;
}

TEST(StereoShift, IsMinusTheDisparity) {
  const StereoShift shift = stereo_shift(view(0, 0), view(kDisparity_px, 0), 200);
  EXPECT_NEAR(shift.shift_px.x, -kDisparity_px, 0.1);
  EXPECT_NEAR(shift.shift_px.y, 0, 0.1);
  EXPECT_GT(shift.response, 0.5);
}

TEST(CameraAlignment, TellsSwappedAndShiftedCamerasFromHealthyOnes) {
  EXPECT_EQ(fault_of(view(0, 0), view(kDisparity_px, 0)), "");
  EXPECT_EQ(fault_of(view(kDisparity_px, 0), view(0, 0)), "cameras swapped");
  // The right camera 50 ms late at 3 m/s forward: 440 px * 0.15 m / 16 m.
  EXPECT_EQ(fault_of(view(0, 0), view(kDisparity_px, 4.1)), "cameras misaligned");
}

TEST(CameraAlignment, SaysNothingOfSwappedCamerasWhereThereIsNoDisparity) {
  EXPECT_EQ(fault_of(view(0.3, 0), view(0, 0), 440 * 0.08 / 0.3), "");
}

TEST(CameraAlignment, SaysNothingWithoutTextureOrDistance) {
  const cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(fault_of(grey, grey), "");
  CameraAlignment alignment({}, rig());
  for (int i = 0; i < 3; ++i) alignment.add(to_nanoseconds(0.1 * i), view(0, 0), view(9, 9), std::nullopt);
  EXPECT_TRUE(alignment.usable());
}

}  // namespace
}  // namespace alight
