#include "geometry/depth_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

const PinholeIntrinsics kCamera{100, 110, 32.2, 20.7, 65, 41};  // odd size, off-centre

TEST(DepthMap, LevelGroundIsConstantInPlaneDepth) {
  const cv::Mat plane(kCamera.size(), CV_32FC1, cv::Scalar(7.5));
  const cv::Mat range = plane_to_perspective(plane, kCamera);
  EXPECT_FLOAT_EQ(range.at<float>(3, 60), static_cast<float>(7.5 * kCamera.ray(60, 3).norm()));
  EXPECT_GT(range.at<float>(0, 0), range.at<float>(20, 32));
  EXPECT_LT(cv::norm(perspective_to_plane(range, kCamera), plane, cv::NORM_INF), 1e-5);
}

TEST(DepthMap, MissingStaysMissing) {
  const cv::Mat none = cv::Mat::zeros(kCamera.size(), CV_32FC1);
  EXPECT_EQ(cv::countNonZero(plane_to_perspective(none, kCamera)), 0);
  EXPECT_EQ(cv::countNonZero(perspective_to_plane(none, kCamera)), 0);
  EXPECT_EQ(cv::countNonZero(fill_nearest(none)), 0);
  EXPECT_EQ(cv::norm(colour_depth(none), cv::NORM_INF), 0);
}

TEST(DepthMap, FillNearestTakesTheNearestPixel) {
  cv::Mat depth = cv::Mat::zeros(21, 33, CV_32FC1);
  depth.at<float>(10, 4) = 5;
  depth.at<float>(10, 28) = 9;
  const cv::Mat filled = fill_nearest(depth);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (u == 16) continue;  // as far from both
      EXPECT_EQ(filled.at<float>(v, u), u < 16 ? 5 : 9) << u << "," << v;
    }
  }
}

TEST(DepthMap, FillNearestStaysInsideItsRegion) {
  cv::Mat depth = cv::Mat::zeros(11, 11, CV_32FC1);
  depth.at<float>(5, 5) = 4;
  cv::Mat region = cv::Mat::zeros(depth.size(), CV_8UC1);
  region(cv::Rect(2, 2, 5, 5)) = 255;
  const cv::Mat filled = fill_nearest(depth, region);
  EXPECT_EQ(cv::countNonZero(filled), 25);
  EXPECT_EQ(filled.at<float>(2, 2), 4);
  EXPECT_EQ(cv::countNonZero(fill_nearest(depth, region, 1)), 5) << "a pixel and its four neighbours";
}

TEST(DepthMap, EncodingKeepsMillimetresAndSaturates) {
  cv::Mat depth(1, 4, CV_32FC1);
  depth.at<float>(0) = 0;
  depth.at<float>(1) = 12.345F;
  depth.at<float>(2) = 255.99F;
  depth.at<float>(3) = 1000;
  const cv::Mat back = decode_depth(encode_depth(depth));
  EXPECT_EQ(back.at<float>(0), 0);
  EXPECT_NEAR(back.at<float>(1), 12.345, 0.5 / 256);
  EXPECT_NEAR(back.at<float>(2), 255.99, 0.5 / 256);
  EXPECT_FLOAT_EQ(back.at<float>(3), 65535.0F / 256);
}

TEST(DepthMap, MedianAndColoursRangeOverTheKnownDepthsAlone) {
  cv::Mat depth = cv::Mat::zeros(3, 100, CV_32FC1);
  EXPECT_FALSE(median_depth_m(depth));
  EXPECT_EQ(colour_range(depth).max_m, 1);
  for (int u = 0; u < 100; ++u) depth.at<float>(1, u) = static_cast<float>(100 - u);  // 1 to 100 m
  EXPECT_EQ(known_depths(depth).size(), 100u);
  EXPECT_EQ(median_depth_m(depth), 51);
  EXPECT_EQ(colour_range(depth).min_m, 2);
  EXPECT_EQ(colour_range(depth).max_m, 99);
  depth.row(1) = 5;
  EXPECT_NEAR(colour_range(depth).max_m - colour_range(depth).min_m, 0.1, 1e-12) << "a range of no width";
}

TEST(DepthMap, ColoursTellNearFromFarAndMissing) {
  cv::Mat depth(1, 3, CV_32FC1);
  depth.at<float>(0) = 0;
  depth.at<float>(1) = 2;
  depth.at<float>(2) = 20;
  const cv::Mat colours = colour_depth(depth, 2, 20);
  EXPECT_EQ(colours.at<cv::Vec3b>(0), cv::Vec3b(0, 0, 0));
  EXPECT_GT(colours.at<cv::Vec3b>(1)[2], colours.at<cv::Vec3b>(1)[0]);  // near: red
  EXPECT_GT(colours.at<cv::Vec3b>(2)[0], 0);
  EXPECT_NE(colours.at<cv::Vec3b>(1), colours.at<cv::Vec3b>(2));
}

}  // namespace
}  // namespace alight
