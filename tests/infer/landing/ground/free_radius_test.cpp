#include "infer/landing/ground/free_radius.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(FreeRadius, ReachesToTheNearestUnsafeEdgeAndNotBeyondTheMap) {
  cv::Mat safe(9, 31, CV_8UC1, cv::Scalar(255));
  safe.at<std::uint8_t>(4, 20) = 0;
  const cv::Mat radius_px = free_radius(safe);
  ASSERT_EQ(radius_px.type(), CV_32FC1);
  EXPECT_FLOAT_EQ(radius_px.at<float>(4, 20), 0);    // unsafe
  EXPECT_FLOAT_EQ(radius_px.at<float>(4, 19), 0.5);  // beside it
  EXPECT_FLOAT_EQ(radius_px.at<float>(4, 8), 4.5);   // the map ends above and below
  EXPECT_FLOAT_EQ(radius_px.at<float>(0, 8), 0.5);
  EXPECT_FLOAT_EQ(radius_px.at<float>(3, 23), std::min(3.5F, std::sqrt(10.F) - 0.5F));
}

TEST(FreeRadius, CountsInSidesOfAPixel) {
  std::mt19937 random(3);
  cv::Mat safe(20, 25, CV_8UC1);
  for (int i = 0; i < 500; ++i) safe.data[i] = random() % 9 == 0 ? 0 : 255;
  const cv::Mat radius_px = free_radius(safe);
  const cv::Mat radius_m = free_radius(safe, 0.2);
  for (int v = 0; v < safe.rows; ++v) {
    for (int u = 0; u < safe.cols; ++u)
      EXPECT_NEAR(radius_m.at<float>(v, u), 0.2 * static_cast<double>(radius_px.at<float>(v, u)), 1e-6);
  }
}

}  // namespace
}  // namespace alight
