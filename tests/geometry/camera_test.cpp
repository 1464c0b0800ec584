#include "geometry/camera.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

Camera make_camera(DistortionModel model, std::vector<double> coeffs) {
  return {{450, 455, 321.2, 198.7, 640, 400}, model, std::move(coeffs)};
}

TEST(PinholeIntrinsics, ProjectAndRayAreInverse) {
  const PinholeIntrinsics k{440, 430, 319.5, 199.5, 640, 400};
  const Eigen::Vector3d p(1.5, -0.7, 8);
  const Eigen::Vector2d pixel = k.project(p);
  EXPECT_NEAR(pixel.x(), 440 * 1.5 / 8 + 319.5, 1e-12);
  EXPECT_NEAR(pixel.y(), 430 * -0.7 / 8 + 199.5, 1e-12);
  EXPECT_TRUE((8 * k.ray(pixel.x(), pixel.y())).isApprox(p, 1e-12));
}

TEST(PinholeIntrinsics, ContainsThePixelsAreaNotOnlyItsCentre) {
  const PinholeIntrinsics k{1, 1, 0, 0, 4, 3};
  EXPECT_TRUE(k.contains(-0.5, -0.5));
  EXPECT_TRUE(k.contains(3.49, 2.49));
  EXPECT_FALSE(k.contains(3.5, 0));
  EXPECT_FALSE(k.contains(0, -0.51));
}

class CameraModels : public ::testing::TestWithParam<Camera> {};

TEST_P(CameraModels, UnprojectInvertsProject) {
  const Camera camera = GetParam();
  for (double x = -0.5; x <= 0.5; x += 0.25) {
    for (double y = -0.35; y <= 0.35; y += 0.175) {
      const Eigen::Vector3d p(3 * x, 3 * y, 3);
      const auto pixel = camera.project(p);
      ASSERT_TRUE(pixel.has_value());
      EXPECT_LT((camera.unproject(*pixel) - p / 3).norm(), 1e-6) << x << " " << y;
    }
  }
  EXPECT_FALSE(camera.project({0, 0, -1}).has_value());
}

INSTANTIATE_TEST_SUITE_P(
    All, CameraModels,
    ::testing::Values(make_camera(DistortionModel::kNone, {}),
                      make_camera(DistortionModel::kRadtan, {-0.28, 0.07, 0.001, -0.0005}),
                      make_camera(DistortionModel::kRadtan, {0.12, -0.085, 0.0025, -0.0038, 0.01}),
                      make_camera(DistortionModel::kRadtan, {0.3, 0.1, 0.001, 0.001, 0.01, 0.4, 0.15, 0.02}),
                      make_camera(DistortionModel::kEquidistant, {-0.01, 0.02, -0.015, 0.004})));

TEST(Camera, RadtanFollowsTheBrownFormula) {
  const double k1 = -0.3, k2 = 0.1, p1 = 0.002, p2 = -0.001;
  const Camera camera = make_camera(DistortionModel::kRadtan, {k1, k2, p1, p2});
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const double radial = 1 + k1 * r2 + k2 * r2 * r2;
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  const auto pixel = camera.project({x, y, 1});
  EXPECT_NEAR(pixel->x(), 450 * xd + 321.2, 1e-9);
  EXPECT_NEAR(pixel->y(), 455 * yd + 198.7, 1e-9);
}

TEST(Camera, EquidistantFollowsKannalaBrandt) {
  const std::vector<double> k = {0.05, -0.01, 0.003, -0.001};
  const Camera camera = make_camera(DistortionModel::kEquidistant, k);
  const double x = 0.6, y = 0.4, r = std::hypot(x, y), theta = std::atan(r), t2 = theta * theta;
  const double theta_d = theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
  const auto pixel = camera.project({x, y, 1});
  EXPECT_NEAR(pixel->x(), 450 * x * theta_d / r + 321.2, 1e-9);
  EXPECT_NEAR(pixel->y(), 455 * y * theta_d / r + 198.7, 1e-9);
}

// Kalibr's zeros say an ideal fisheye, not a pinhole.
TEST(Camera, EquidistantWithoutCoefficientsIsNoPinhole) {
  const Camera camera = make_camera(DistortionModel::kEquidistant, {0, 0, 0, 0});
  const auto pixel = camera.project({1, 0, 1});
  EXPECT_NEAR(pixel->x(), 450 * kPi / 4 + 321.2, 1e-9);
  EXPECT_NEAR(camera.unproject(*pixel).x(), 1, 1e-9);
}

}  // namespace
}  // namespace alight
