#include "infer/depth/interpolation.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(Interpolation, FillsInsideTheFieldOfViewAndNowhereElse) {
  cv::Mat sparse = cv::Mat::zeros(21, 31, CV_32FC1);
  sparse.at<float>(10, 10) = 5;
  sparse.at<float>(10, 20) = 9;
  cv::Mat fov = cv::Mat::zeros(21, 31, CV_8UC1);
  fov(cv::Rect(8, 8, 15, 5)).setTo(255);
  const cv::Mat filled = interpolate_inside_fov(sparse, fov, {});
  EXPECT_EQ(cv::countNonZero(filled), 15 * 5);
  EXPECT_EQ(filled.at<float>(10, 14), 5);
  EXPECT_EQ(filled.at<float>(10, 16), 9);
  EXPECT_EQ(filled.at<float>(5, 10), 0);
}

TEST(Interpolation, LeavesHolesWhereNoPointIsNear) {
  cv::Mat sparse = cv::Mat::zeros(1, 101, CV_32FC1);
  sparse.at<float>(0, 0) = 5;
  sparse.at<float>(0, 100) = 5;
  const cv::Mat everywhere(1, 101, CV_8UC1, cv::Scalar(255));
  InterpolationConfig config;
  config.max_distance_px = 12;
  const cv::Mat filled = interpolate_inside_fov(sparse, everywhere, config);
  EXPECT_EQ(cv::countNonZero(filled), 2 * 13);
  EXPECT_EQ(filled.at<float>(0, 12), 5);
  EXPECT_EQ(filled.at<float>(0, 13), 0);
  config.max_distance_px = 0;
  EXPECT_EQ(cv::countNonZero(interpolate_inside_fov(sparse, everywhere, config)), 101);
}

TEST(Interpolation, NoPointsMakeNoDepth) {
  const cv::Mat nothing = cv::Mat::zeros(7, 9, CV_32FC1);
  EXPECT_EQ(cv::countNonZero(interpolate_inside_fov(nothing, cv::Mat(7, 9, CV_8UC1, cv::Scalar(255)), {})),
            0);
}

}  // namespace
}  // namespace alight
