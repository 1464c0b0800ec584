#include "train/evaluation/methods/ip_basic.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

cv::Mat point(cv::Size size, cv::Point at, float depth_m) {
  cv::Mat sparse = cv::Mat::zeros(size, CV_32FC1);
  sparse.at<float>(at) = depth_m;
  return sparse;
}

TEST(IpBasic, OnePointFillsTheImage) {
  const cv::Mat filled = fill_ip_basic(point({101, 83}, {50, 40}, 12.5F));
  EXPECT_LT(cv::norm(filled, cv::Mat(filled.size(), CV_32FC1, cv::Scalar(12.5)), cv::NORM_INF), 1e-4);
}

/// Two points at columns 20 and 61. The diamonds reach 2 px, the 7x7 filling 3 more and the 31x31 another 15: the near
/// point's region ends at 40, the far point's begins at 41. Median and Gaussian blur 4 px on either side.
TEST(IpBasic, EveryStepReachesAsFarAsItsKernel) {
  cv::Mat sparse = point({100, 41}, {20, 20}, 10);
  sparse.at<float>(20, 61) = 30;
  const cv::Mat filled = fill_ip_basic(sparse);
  EXPECT_NEAR(filled.at<float>(20, 0), 10, 1e-4);
  EXPECT_NEAR(filled.at<float>(20, 36), 10, 1e-4);
  EXPECT_NEAR(filled.at<float>(20, 45), 30, 1e-4);
  EXPECT_NEAR(filled.at<float>(20, 99), 30, 1e-4);
}

TEST(IpBasic, WhereBothReachTheNearerWins) {
  cv::Mat sparse = point({100, 41}, {20, 20}, 10);
  sparse.at<float>(20, 50) = 30;  // reaches back to 30, the near point forth to 40
  const cv::Mat filled = fill_ip_basic(sparse);
  EXPECT_NEAR(filled.at<float>(20, 36), 10, 1e-4);
  EXPECT_NEAR(filled.at<float>(20, 45), 30, 1e-4);
}

TEST(IpBasic, AnIsolatedOutlierIsRemovedByTheMedian) {
  cv::Mat sparse(60, 60, CV_32FC1, cv::Scalar(20));
  sparse.at<float>(30, 30) = 60;  // the farther of two depths never survives the dilation
  EXPECT_NEAR(fill_ip_basic(sparse).at<float>(30, 30), 20, 1e-4);
}

TEST(IpBasic, DepthsBeyondTheRangeAreKept) {
  EXPECT_NEAR(fill_ip_basic(point({40, 40}, {5, 5}, 140.0F)).at<float>(30, 30), 140, 1e-3);
}

TEST(IpBasic, NoPointGivesNothing) {
  EXPECT_EQ(cv::countNonZero(fill_ip_basic(cv::Mat::zeros(30, 20, CV_32FC1))), 0);
}

}  // namespace
}  // namespace alight
