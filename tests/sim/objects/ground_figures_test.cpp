#include "sim/objects/ground_figures.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

TEST(GroundRect, DistanceIsToTheNearestEdgeOrCorner) {
  // 4 m by 2 m, turned by a quarter: it lies along north.
  const GroundRect rect{{10, 0}, 2, 1, {0, 1}};
  EXPECT_EQ(rect.distance_m({10.9, 1.9}), 0);
  EXPECT_DOUBLE_EQ(rect.distance_m({10, 5}), 3);
  EXPECT_DOUBLE_EQ(rect.distance_m({7, 0}), 2);
  EXPECT_DOUBLE_EQ(rect.distance_m({14, 6}), 5);  // from the corner (11, 2)
  EXPECT_TRUE(rect.at(2, 1).isApprox(Eigen::Vector2d(9, 2)));
}

TEST(GroundSegment, NearestStaysBetweenItsEnds) {
  const GroundSegment segment{{0, 0}, {10, 0}};
  EXPECT_TRUE(segment.nearest({4, 7}).isApprox(Eigen::Vector2d(4, 0)));
  EXPECT_TRUE(segment.nearest({-3, 7}).isZero());
  EXPECT_TRUE(segment.nearest({13, 7}).isApprox(Eigen::Vector2d(10, 0)));
}

TEST(Heading, LeftOfItIsAQuarterFurther) {
  EXPECT_TRUE(left_of(heading(0.4)).isApprox(heading(0.4 + std::acos(0.0))));
}

}  // namespace
}  // namespace alight::sim
