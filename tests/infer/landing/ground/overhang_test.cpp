#include "infer/landing/ground/overhang.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::camera_of;

TEST(GroundBeneath, LiesWhereTheColumnMeetsTheGround) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = scenes::level_ground(k, 20);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(76, 276) =
      10;  // (100, -100) px from the centre at half the depth: (50, -50) px on the ground
  obstacle.at<std::uint8_t>(76, 276) = 255;
  const cv::Mat beneath = ground_beneath(depth, obstacle, k, 0.5);
  EXPECT_EQ(cv::countNonZero(beneath), 9);
  EXPECT_EQ(beneath.at<std::uint8_t>(176 - 50, 176 + 50), 255);
}

TEST(GroundBeneath, FollowsSlopingGround) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = scenes::plane(k, 20, 0.1, 0);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(176, 276) = 10;
  obstacle.at<std::uint8_t>(176, 276) = 255;
  const double x_m = 100.0 / 440 * 10;
  const double u_px = 176 + 440 * x_m / (20 + 0.1 * x_m);
  const cv::Mat beneath = ground_beneath(depth, obstacle, k, 0.5);
  EXPECT_EQ(beneath.at<std::uint8_t>(176, static_cast<int>(std::lround(u_px))), 255);
}

TEST(GroundBeneath, ObstaclesOnTheGroundHaveNothingBelow) {
  const PinholeIntrinsics k = camera_of(353, 353);
  const cv::Mat depth = scenes::level_ground(k, 20);
  const cv::Mat all(353, 353, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(cv::countNonZero(ground_beneath(depth, all, k, 0.5)), 0);
  EXPECT_EQ(cv::countNonZero(ground_beneath(cv::Mat::zeros(353, 353, CV_32FC1), all, k, 0.5)), 0);
}

TEST(GroundBeneath, UnknownGroundStaysUnmarked) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = cv::Mat::zeros(353, 353, CV_32FC1);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(76, 276) = 10;
  depth.at<float>(300, 300) = 20;
  obstacle.at<std::uint8_t>(76, 276) = 255;
  EXPECT_EQ(cv::countNonZero(ground_beneath(depth, obstacle, k, 0.5)), 0);
}

/// The columns over level ground `height_m` below a camera, and the raster.
cv::Mat columns_over_level_ground(const Eigen::Matrix3d& R_world_camera, double height_m, double column_m,
                                  ElevationRaster& raster) {
  const PinholeIntrinsics k = camera_of(352, 352);
  Eigen::Isometry3d T_world_camera(Eigen::Translation3d(3, -4, height_m));
  T_world_camera.linear() = R_world_camera;
  raster = rasterize(scenes::level_ground_seen(k, height_m, R_world_camera), k, T_world_camera, 0.1, 60);
  return columns_in_view(raster, k, T_world_camera, column_m);
}

TEST(ColumnsInView, LeaveTheMiddleOfTheImage) {
  // At the column's top the view is as wide as that of a camera which is higher by it.
  ElevationRaster raster;
  const double half_view = 176 / 440.0;
  for (const double column_m : {0.5, 2.0, 5.0, 9.0}) {
    const cv::Mat seen = columns_over_level_ground(scenes::attitude(0, 0), 10, column_m, raster);
    const double side_m = 2 * half_view * (10 - column_m);
    EXPECT_NEAR(cv::countNonZero(seen) * 0.01, side_m * side_m, 0.25 * side_m) << column_m;
    int column = 0;
    int row = 0;
    ASSERT_TRUE(raster.cell_at(3, -4, column, row));
    EXPECT_EQ(seen.at<std::uint8_t>(row, column), 255);
  }
  EXPECT_EQ(cv::countNonZero(columns_over_level_ground(scenes::attitude(0, 0), 10, 10.5, raster)), 0);
}

TEST(ColumnsInView, EndWhereTheCamerasOwnImageEnds) {
  ElevationRaster raster;
  const double tilt = to_radians(15);
  const Eigen::Matrix3d R = scenes::attitude(0, tilt);
  const cv::Mat seen = columns_over_level_ground(R, 20, 6, raster);
  // East of the camera the image ends at atan(0.4) one way from its axis; the axis is 15 degrees off the vertical.
  const bool axis_east = (R * Eigen::Vector3d::UnitZ()).x() > 0;
  const double half_view = std::atan(176 / 440.0);
  const double east_m = 14 * std::tan(half_view + (axis_east ? tilt : -tilt));
  const double west_m = 14 * std::tan(half_view - (axis_east ? tilt : -tilt));
  int begin = seen.cols;
  int end = 0;
  int column = 0;
  int row = 0;
  ASSERT_TRUE(raster.cell_at(3, -4, column, row));
  for (int c = 0; c < seen.cols; ++c) {
    if (seen.at<std::uint8_t>(row, c) == 0) continue;
    begin = std::min(begin, c);
    end = std::max(end, c);
  }
  EXPECT_NEAR(raster.centre_m(end, row).x() - 3, east_m, 0.15);
  EXPECT_NEAR(3 - raster.centre_m(begin, row).x(), west_m, 0.15);
}

}  // namespace
}  // namespace alight
