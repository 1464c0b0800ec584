#include "geometry/geodesy.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

TEST(LocalEnu, AxesAreEastNorthUp) {
  const LocalEnu enu(40.0, 116.3, 50);
  EXPECT_LT(enu.to_world(40.0, 116.3, 50).norm(), 1e-9);
  EXPECT_GT(enu.to_world(40.0, 116.301, 50).x(), 80);
  EXPECT_GT(enu.to_world(40.001, 116.3, 50).y(), 110);
  EXPECT_NEAR(enu.to_world(40.0, 116.3, 62.5).z(), 12.5, 1e-9);
}

TEST(LocalEnu, MetresPerDegreeFollowTheEllipsoid) {
  // Meridian radius of curvature of WGS84 at the origin: M = a (1 - e^2) / (1 - e^2 sin^2)^1.5
  const double a = 6378137.0, f = 1 / 298.257223563, e2 = f * (2 - f);
  const double lat = to_radians(48.0), s2 = std::sin(lat) * std::sin(lat);
  const double M = a * (1 - e2) / std::pow(1 - e2 * s2, 1.5);
  const double step_deg = 1e-4;
  const LocalEnu enu(48.0, 11.0, 0);
  EXPECT_NEAR(enu.to_world(48.0 + step_deg, 11.0, 0).y(), M * to_radians(step_deg), 1e-4);
}

TEST(LocalEnu, RoundTrip) {
  const LocalEnu enu(-33.9, 151.2, 20);
  const Eigen::Vector3d p(120, -345, 38);
  const Eigen::Vector3d g = enu.to_geodetic(p);
  EXPECT_LT((enu.to_world(g.x(), g.y(), g.z()) - p).norm(), 1e-6);
}

}  // namespace
}  // namespace alight
