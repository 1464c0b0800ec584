#include "train/evaluation/methods/delaunay.hpp"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace alight {
namespace {

cv::Mat map_of(cv::Size size, const std::function<double(int, int)>& value) {
  cv::Mat map(size, CV_32FC1);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) map.at<float>(v, u) = static_cast<float>(value(u, v));
  }
  return map;
}

/// A share of the pixels, and the four corners, so that the convex hull is the whole image.
cv::Mat thinned(const cv::Mat& map, double share) {
  std::mt19937 random(4);
  std::bernoulli_distribution kept(share);
  cv::Mat sparse = cv::Mat::zeros(map.size(), CV_32FC1);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      const bool corner = (v == 0 || v == map.rows - 1) && (u == 0 || u == map.cols - 1);
      if (corner || kept(random)) sparse.at<float>(v, u) = map.at<float>(v, u);
    }
  }
  return sparse;
}

double largest_difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(Delaunay, LinearDepthIsExact) {
  const cv::Mat plane = map_of({61, 47}, [](int u, int v) { return 20 + 0.11 * u - 0.07 * v; });
  EXPECT_LT(largest_difference(fill_delaunay(thinned(plane, 0.05)), plane), 1e-5);
}

TEST(Delaunay, TiltedGroundIsExactInInverseDepthAlone) {
  const cv::Mat ground = map_of({61, 47}, [](int u, int v) { return 1 / (0.05 + 5e-4 * u - 3e-4 * v); });
  const cv::Mat sparse = thinned(ground, 0.05);
  EXPECT_LT(largest_difference(fill_delaunay(sparse, LinearQuantity::kInverseDepth), ground), 1e-4);
  EXPECT_GT(largest_difference(fill_delaunay(sparse, LinearQuantity::kDepth), ground), 1e-2);
}

TEST(Delaunay, ATriangleByHand) {
  cv::Mat sparse = cv::Mat::zeros(5, 5, CV_32FC1);
  sparse.at<float>(0, 0) = 10;
  sparse.at<float>(0, 4) = 14;
  sparse.at<float>(4, 0) = 18;
  const cv::Mat filled = fill_delaunay(sparse);
  EXPECT_FLOAT_EQ(filled.at<float>(0, 2), 12);  // on an edge
  EXPECT_FLOAT_EQ(filled.at<float>(1, 1), 13);
  EXPECT_FLOAT_EQ(filled.at<float>(2, 2), 16);  // the middle of the long edge
  EXPECT_FLOAT_EQ(filled.at<float>(4, 3), 18);  // outside: the nearest point
  EXPECT_FLOAT_EQ(filled.at<float>(1, 4), 14);
}

TEST(Delaunay, PointsKeepTheirDepth) {
  const cv::Mat noise = map_of({40, 30}, [](int u, int v) { return 5 + (u * 37 + v * 91) % 23 / 7.0; });
  const cv::Mat sparse = thinned(noise, 0.5);
  const cv::Mat filled = fill_delaunay(sparse, LinearQuantity::kInverseDepth);
  cv::Mat kept = cv::Mat::zeros(sparse.size(), CV_32FC1);
  filled.copyTo(kept, sparse > 0);
  EXPECT_EQ(largest_difference(kept, sparse), 0);
  EXPECT_EQ(cv::countNonZero(filled > 0), 40 * 30);
}

TEST(Delaunay, OneLineOfPointsIsExtendedByTheNearest) {
  cv::Mat sparse = cv::Mat::zeros(7, 9, CV_32FC1);
  sparse.at<float>(3, 1) = 4;
  sparse.at<float>(3, 7) = 8;
  const cv::Mat filled = fill_delaunay(sparse);
  EXPECT_FLOAT_EQ(filled.at<float>(0, 0), 4);
  EXPECT_FLOAT_EQ(filled.at<float>(6, 8), 8);
}

TEST(Delaunay, NoPointGivesNothing) {
  EXPECT_EQ(cv::countNonZero(fill_delaunay(cv::Mat::zeros(5, 6, CV_32FC1))), 0);
}

}  // namespace
}  // namespace alight
