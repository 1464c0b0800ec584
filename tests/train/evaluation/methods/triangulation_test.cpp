#include "train/evaluation/methods/triangulation.hpp"

#include <cstdint>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alight {
namespace {

std::int64_t twice_area(cv::Point a, cv::Point b, cv::Point c) {
  return static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) -
         static_cast<std::int64_t>(b.y - a.y) * (c.x - a.x);
}

std::int64_t twice_area(const std::vector<cv::Point>& points, const std::vector<Triangle>& triangles) {
  std::int64_t sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const std::int64_t area =
        twice_area(points.at(static_cast<std::size_t>(a)), points.at(static_cast<std::size_t>(b)),
                   points.at(static_cast<std::size_t>(c)));
    EXPECT_GT(area, 0) << "not counter-clockwise";
    sum += area;
  }
  return sum;
}

std::vector<cv::Point> random_points(int count, int side, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(0, side - 1);
  std::vector<cv::Point> points;
  for (int i = 0; i < count; ++i) points.emplace_back(place(random), place(random));
  return points;
}

/// Twice the area of the convex hull (Andrew's monotone chain), independent of the triangulation.
std::int64_t twice_hull_area(std::vector<cv::Point> points) {
  const auto less = [](cv::Point a, cv::Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::sort(points.begin(), points.end(), less);
  std::vector<cv::Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const cv::Point& p : points) {
      while (hull.size() >= start + 2 && twice_area(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const cv::Point next = hull[(i + 1) % hull.size()];
    sum += static_cast<std::int64_t>(hull[i].x) * next.y - static_cast<std::int64_t>(hull[i].y) * next.x;
  }
  return sum;
}

bool in_circle(cv::Point a, cv::Point b, cv::Point c, cv::Point d) {
  const auto lift = [d](cv::Point p) {
    return std::array<double, 3>{double(p.x - d.x), double(p.y - d.y),
                                 double((p.x - d.x) * (p.x - d.x) + (p.y - d.y) * (p.y - d.y))};
  };
  const auto A = lift(a), B = lift(b), C = lift(c);
  return A[2] * (B[0] * C[1] - C[0] * B[1]) - B[2] * (A[0] * C[1] - C[0] * A[1]) +
             C[2] * (A[0] * B[1] - B[0] * A[1]) >
         0;
}

TEST(Triangulation, ASquareIsTwoTriangles) {
  const std::vector<cv::Point> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const auto triangles = triangulate(square);
  EXPECT_EQ(triangles.size(), 2U);
  EXPECT_EQ(twice_area(square, triangles), 32);
}

TEST(Triangulation, TooFewOrCollinearPointsMakeNone) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{1, 1}}).empty());
  EXPECT_TRUE(triangulate({{1, 1}, {2, 5}}).empty());
  EXPECT_TRUE(triangulate({{1, 1}, {1, 1}, {1, 1}}).empty());
  EXPECT_TRUE(triangulate({{0, 0}, {1, 2}, {2, 4}, {3, 6}, {5, 10}}).empty());
  EXPECT_TRUE(triangulate({{7, 0}, {7, 1}, {7, 2}, {7, 3}}).empty());
}

TEST(Triangulation, NoPointLiesInACircle) {
  const auto points = random_points(200, 40, 1);  // many at the same place, on lines and on circles
  const auto triangles = triangulate(points);
  ASSERT_FALSE(triangles.empty());
  for (const auto& [a, b, c] : triangles) {
    for (const cv::Point& p : points) {
      EXPECT_FALSE(in_circle(points[static_cast<std::size_t>(a)], points[static_cast<std::size_t>(b)],
                             points[static_cast<std::size_t>(c)], p));
    }
  }
}

class TriangulationOfMany : public ::testing::TestWithParam<int> {};

TEST_P(TriangulationOfMany, CoversTheConvexHullOnceAndUsesEveryPlace) {
  const auto points = random_points(GetParam(), 352, static_cast<unsigned>(GetParam()));
  const auto triangles = triangulate(points);
  EXPECT_EQ(twice_area(points, triangles), twice_hull_area(points));
  std::set<std::pair<int, int>> places, used;
  for (const cv::Point& p : points) places.insert({p.x, p.y});
  for (const Triangle& triangle : triangles) {
    for (const int i : triangle) {
      const cv::Point p = points[static_cast<std::size_t>(i)];
      used.insert({p.x, p.y});
    }
  }
  EXPECT_EQ(used, places);
}

INSTANTIATE_TEST_SUITE_P(Points, TriangulationOfMany, ::testing::Values(4, 5, 17, 1000, 40'000, 100'000));

TEST(Triangulation, AFullGridIsTwoTrianglesACell) {
  std::vector<cv::Point> points;
  for (int v = 0; v < 31; ++v) {
    for (int u = 0; u < 45; ++u) points.emplace_back(u, v);
  }
  const auto triangles = triangulate(points);
  EXPECT_EQ(triangles.size(), 2U * 30 * 44);
  EXPECT_EQ(twice_area(points, triangles), 2 * 30 * 44);
}

TEST(Triangulation, CoordinatesThatWouldOverflowAreRefused) {
  EXPECT_EQ(triangulate({{-8191, -8191}, {8191, -8191}, {8191, 8191}, {-8191, 8191}}).size(), 2U);
  EXPECT_THROW(triangulate({{0, 0}, {8192, 0}, {0, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace alight
