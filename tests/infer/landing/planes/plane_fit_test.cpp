#include "infer/landing/planes/plane_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::camera_at;
using scenes::camera_of;
using scenes::plane_seen;

TEST(FitPlanes, PlanesOfAnySlopeAreExactFromAnyHeightAndAttitude) {
  const PinholeIntrinsics k = camera_of(352, 352);
  for (const double height_m : {8.0, 20.0, 40.0}) {
    for (const double tilt_deg : {0.0, 15.0}) {
      const Eigen::Isometry3d T = camera_at(512.3, -77.7, 300 + height_m, tilt_deg, -tilt_deg, 0.6);
      const double gx = 0.1;
      const double gy = -0.12;
      const double z0_m = 300 - gx * 512.3 + gy * 77.7;
      const cv::Mat depth = plane_seen(k, T, z0_m, gx, gy);
      const ElevationRaster raster = rasterize(depth, k, T, 0.2, 60);
      const GroundShape shape = fit_planes(raster, {});
      ASSERT_GT(cv::countNonZero(shape.known), 60);
      double residual_m = 0;
      cv::minMaxLoc(shape.residual_m, nullptr, &residual_m);
      EXPECT_LT(residual_m, 0.005);
      for (int row = 0; row < shape.known.rows; ++row) {
        for (int column = 0; column < shape.known.cols; ++column) {
          if (shape.known.at<std::uint8_t>(row, column) == 0) continue;
          EXPECT_NEAR(std::atan(shape.gradient.at<float>(row, column)), std::atan(std::hypot(gx, gy)),
                      to_radians(0.1));
        }
      }
    }
  }
}

TEST(FitPlanes, AStepOfTheDiscHasItsKnownResidual) {
  // One cell stands h over level ground: the plane rises by h / n, so h (1 - 1/n) is left.
  ElevationRaster raster;
  raster.cell_m = 0.2;
  raster.mean_m = cv::Mat::zeros(21, 21, CV_32FC1);
  raster.mean_m.at<float>(10, 10) = 0.5F;
  raster.east_m = cv::Mat::zeros(21, 21, CV_32FC1);
  raster.north_m = cv::Mat::zeros(21, 21, CV_32FC1);
  raster.top_m = raster.mean_m.clone();
  raster.bottom_m = raster.mean_m.clone();
  raster.known = cv::Mat(21, 21, CV_8UC1, cv::Scalar(255));
  const GroundShape shape = fit_planes(raster, {});
  EXPECT_NEAR(shape.residual_m.at<float>(10, 10), 0.5 * (1 - 1 / 29.0), 1e-5);
  EXPECT_NEAR(shape.deviation_m.at<float>(10, 10), 0.5 * (1 - 1 / 29.0), 1e-5);
  EXPECT_NEAR(shape.gradient.at<float>(10, 10), 0, 1e-6);
  EXPECT_GT(shape.residual_m.at<float>(10, 13), 0.3);
  EXPECT_LT(shape.deviation_m.at<float>(10, 13), 0.2);
  EXPECT_NEAR(shape.residual_m.at<float>(10, 14), 0, 1e-6);
  EXPECT_EQ(shape.known.at<std::uint8_t>(2, 10), 0);
  EXPECT_EQ(shape.known.at<std::uint8_t>(3, 10), 255);
}

}  // namespace
}  // namespace alight
