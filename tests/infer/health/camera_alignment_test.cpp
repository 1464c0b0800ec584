#include "infer/health/camera_alignment.hpp"

#include <cstdint>
#include <vector>

#include <opencv2/imgcodecs.hpp>
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

/// Smooth ground: its texture is `scale_px` wide.
cv::Mat smooth_view(double x_px, double y_px, double scale_px) {
  cv::Mat ground(320, 400, CV_32FC1);
  cv::RNG random(5);
  random.fill(ground, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(ground, ground, {0, 0}, scale_px);
  cv::normalize(ground, ground, 60, 190, cv::NORM_MINMAX);
  const cv::Matx23d move(1, 0, 40 + x_px, 0, 1, 40 + y_px);
  cv::Mat image;
  cv::warpAffine(ground, image, move, {320, 240}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  return image;
}

cv::Mat as_seen(const cv::Mat& real, double noise, int seed, const cv::Mat& pattern = {}) {
  cv::Mat out = real.clone();
  cv::Mat grains(real.size(), CV_32FC1);
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(grains, cv::RNG::NORMAL, 0, noise);
  if (noise > 0) out += grains;
  if (!pattern.empty()) out += pattern;
  cv::Mat image;
  out.convertTo(image, CV_8UC1);
  return image;
}

cv::Mat by_jpeg(const cv::Mat& image, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

TEST(CameraAlignment, SaysNothingOfHealthyPairsOverSmoothGroundWhateverTheNoise) {
  cv::Mat pattern(240, 320, CV_32FC1);
  for (const double scale_px : {2.0, 5.0, 12.0, 30.0}) {
    const cv::Mat left = smooth_view(0, 0, scale_px);
    const cv::Mat right = smooth_view(kDisparity_px, 0, scale_px);
    for (const double noise : {0.0, 1.0, 2.0, 5.0}) {
      EXPECT_EQ(fault_of(as_seen(left, noise, 1), as_seen(right, noise, 2)), "")
          << scale_px << " px, " << noise;
      for (const int quality : {50, 90})
        EXPECT_EQ(
            fault_of(by_jpeg(as_seen(left, noise, 1), quality), by_jpeg(as_seen(right, noise, 2), quality)),
            "")
            << scale_px << " px, " << noise << ", JPEG " << quality;
    }
    for (const double fixed : {0.7, 2.0, 5.0}) {
      cv::RNG(3).fill(pattern, cv::RNG::NORMAL, 0, fixed);
      EXPECT_EQ(fault_of(as_seen(left, 0, 1, pattern), as_seen(right, 0, 2, pattern)), "")
          << scale_px << " px, a pattern of " << fixed;
    }
  }
}

TEST(CameraAlignment, FindsLateCamerasThroughNoiseAndJpeg) {
  for (const double noise : {0.0, 2.0, 5.0}) {
    const cv::Mat left = by_jpeg(as_seen(smooth_view(0, 0, 2), noise, 1), 90);
    EXPECT_EQ(fault_of(left, by_jpeg(as_seen(smooth_view(kDisparity_px, 8, 2), noise, 2), 90)),
              "cameras misaligned")
        << noise;
  }
}

TEST(CameraAlignment, OnePictureUnderTwoNamesIsFound) {
  const cv::Mat image = view(0, 0);
  EXPECT_EQ(fault_of(image, image), "cameras misaligned");
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
