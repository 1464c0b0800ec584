#include "geometry/projection.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

const PinholeIntrinsics kSquareCamera{440, 440, 175.5, 175.5, 352, 352};

WorldPoint at(double x, double y, double z, std::int64_t t_ns = 0) { return {t_ns, {x, y, z}}; }

TEST(ProjectPoints, NearestPixelAndDepth) {
  SparseDepth out = SparseDepth::empty(kSquareCamera.size());
  const int inside = project_points({at(1, -0.5, 10, 3'000'000)}, Eigen::Isometry3d::Identity(),
                                    kSquareCamera, 1'000'000, {}, out);
  EXPECT_EQ(inside, 1);
  const int u = static_cast<int>(std::lround(440 * 0.1 + 175.5));
  const int v = static_cast<int>(std::lround(440 * -0.05 + 175.5));
  EXPECT_EQ(out.count(), 1);
  EXPECT_EQ(out.depth_m.at<float>(v, u), 10);
  EXPECT_EQ(out.offset_us.at<int>(v, u), 2000);
}

TEST(ProjectPoints, ClosestInTimeWinsWhateverTheOrder) {
  const std::vector<WorldPoint> points = {at(0, 0, 10, 40'000'000), at(0, 0, 11, -30'000'000),
                                          at(0, 0, 9, 50'000'000)};
  for (int first = 0; first < 3; ++first) {
    SparseDepth out = SparseDepth::empty(kSquareCamera.size());
    for (int i = 0; i < 3; ++i) {
      project_points({points[static_cast<std::size_t>((first + i) % 3)]}, Eigen::Isometry3d::Identity(),
                     kSquareCamera, 0, {}, out);
    }
    EXPECT_EQ(out.depth_m.at<float>(176, 176), 11);
    EXPECT_EQ(out.offset_us.at<int>(176, 176), -30000);
  }
}

TEST(ProjectPoints, AtEqualTimesTheNearerSurfaceWins) {
  SparseDepth out = SparseDepth::empty(kSquareCamera.size());
  project_points({at(0, 0, 10, 5000), at(0, 0, 4, 5000), at(0, 0, 8, -5000)}, Eigen::Isometry3d::Identity(),
                 kSquareCamera, 0, {}, out);
  EXPECT_EQ(out.depth_m.at<float>(176, 176), 4);
}

TEST(ProjectPoints, LeavesOutWhatIsBehindBesideOrBeyond) {
  SparseDepth out = SparseDepth::empty(kSquareCamera.size());
  const double nan = std::nan("");
  const int inside =
      project_points({at(0, 0, -5), at(10, 0, 5), at(0, 0, 0.4), at(0, 0, 300), at(nan, 0, 5), at(0, 0, nan)},
                     Eigen::Isometry3d::Identity(), kSquareCamera, 0, DepthRange{0.5, 250}, out);
  EXPECT_EQ(inside, 0);
  EXPECT_EQ(out.count(), 0);
}

TEST(ProjectPoints, UsesThePose) {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  T_camera_world.linear() =
      Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();  // looks down
  T_camera_world.translation() = T_camera_world.linear() * -Eigen::Vector3d(5, 6, 20);
  SparseDepth out = SparseDepth::empty(kSquareCamera.size());
  project_points({at(6, 6, 2)}, T_camera_world, kSquareCamera, 0, {}, out);
  const int u = static_cast<int>(std::floor(440.0 / 18 + 175.5 + 0.5));
  EXPECT_EQ(out.depth_m.at<float>(176, u), 18);
}

TEST(LidarFovMask, CircleOfTheLivoxIs306PixelsWide) {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const cv::Mat mask = lidar_fov_mask(kSquareCamera, T_camera_lidar, to_radians(19.174), 10);
  const int width = cv::countNonZero(mask.row(175));
  EXPECT_NEAR(width, 2 * 440 * std::tan(to_radians(19.174)), 2);
  EXPECT_EQ(mask.at<std::uint8_t>(0, 0), 0);
  const double radius = 440 * std::tan(to_radians(19.174));
  EXPECT_NEAR(cv::countNonZero(mask), kPi * radius * radius, 700);
}

}  // namespace
}  // namespace alight
