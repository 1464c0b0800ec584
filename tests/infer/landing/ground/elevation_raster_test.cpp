#include "infer/landing/ground/elevation_raster.hpp"

#include <gtest/gtest.h>

#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::camera_at;
using scenes::camera_of;
using scenes::plane_seen;

TEST(Rasterize, PutsEveryPointIntoItsCellOfTheWorld) {
  const PinholeIntrinsics k = camera_of(64, 48);
  const Eigen::Isometry3d T = camera_at(-103.37, 54.21, 20, 8, -5, 1.1);
  const cv::Mat depth = plane_seen(k, T, 3, 0.1, -0.2);
  const ElevationRaster raster = rasterize(depth, k, T, 0.2, 60);
  cv::Mat filled = cv::Mat::zeros(raster.size(), CV_8UC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d p = T * (k.ray(u, v) * static_cast<double>(depth.at<float>(v, u)));
      int column = 0;
      int row = 0;
      ASSERT_TRUE(raster.cell_at(p.x(), p.y(), column, row));
      // Points on the very border between two cells may fall on either side of it.
      const Eigen::Vector2d off = p.head<2>() - raster.centre_m(column, row);
      EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.1 + 1e-5);
      if (off.cwiseAbs().maxCoeff() > 0.099) continue;
      filled.at<std::uint8_t>(row, column) = 255;
      EXPECT_LE(p.z(), raster.top_m.at<float>(row, column) + 1e-3);
      EXPECT_GE(p.z(), raster.bottom_m.at<float>(row, column) - 1e-3);
    }
  }
  EXPECT_EQ(cv::countNonZero(filled & ~raster.known), 0);
}

TEST(Rasterize, NothingKnownGivesNothingAndFarGroundIsLeftOut) {
  const PinholeIntrinsics k = camera_of(64, 48);
  EXPECT_TRUE(rasterize(cv::Mat::zeros(48, 64, CV_32FC1), k, camera_at(0, 0, 20), 0.2, 60).empty());
  const cv::Mat deep(48, 64, CV_32FC1, cv::Scalar(900));  // its corners are 65 m aside
  const ElevationRaster raster = rasterize(deep, k, camera_at(0, 0, 20), 0.2, 30);
  EXPECT_LE(raster.size().width, 301);
  EXPECT_THROW(rasterize(deep, camera_of(65, 48), camera_at(0, 0, 20), 0.2, 30), std::invalid_argument);
  EXPECT_THROW(rasterize(deep, k, camera_at(0, 0, 20), 0, 30), std::invalid_argument);
}

}  // namespace
}  // namespace alight
