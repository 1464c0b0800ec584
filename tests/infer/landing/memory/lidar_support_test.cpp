#include "infer/landing/memory/lidar_support.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

class LidarReturnsTest : public testing::Test {
 protected:
  LidarReturnsTest() : sparse_m_(cv::Mat::zeros(k_.size(), CV_32FC1)) {
    T_world_camera_.linear() = scenes::attitude(0, 0);
    T_world_camera_.translation() = Eigen::Vector3d(100, -50, 20);
  }
  /// Puts a point of this depth into the pixel. @returns it in the world
  Eigen::Vector3d point(int u, int v, float depth_m) {
    sparse_m_.at<float>(v, u) = depth_m;
    return T_world_camera_ * (k_.ray(u, v) * static_cast<double>(depth_m));
  }
  LidarReturns returns(double cell_m, double reach_m = 60, double half_fov_deg = 17) const {
    return lidar_returns(sparse_m_, k_, T_world_camera_, cell_m, reach_m, half_fov_deg);
  }

  PinholeIntrinsics k_ = scenes::camera_of(64, 48);
  cv::Mat sparse_m_;
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity();
};

TEST_F(LidarReturnsTest, PointsAreFoundWhereTheyFell) {
  const Eigen::Vector3d p = point(10, 7, 18);
  const LidarReturns out = returns(0.2);
  int column = 0;
  int row = 0;
  const auto c = static_cast<std::int64_t>(std::floor(p.x() / 0.2));
  const auto r = static_cast<std::int64_t>(std::floor(p.y() / 0.2));
  ASSERT_TRUE(out.hit(c, r, column, row));
  EXPECT_EQ(out.count.at<float>(row, column), 1);
  EXPECT_NEAR(out.mean_m.at<float>(row, column), p.z(), 1e-5);
  EXPECT_FALSE(out.hit(c + 1, r, column, row));
  EXPECT_FALSE(out.hit(c, r - 1, column, row));
}

TEST_F(LidarReturnsTest, ACellHasMeanHighestAndLowestOfItsPoints) {
  point(32, 24, 20);
  point(33, 24, 19);
  point(32, 25, 17);
  const LidarReturns out = returns(1000, 2000);
  ASSERT_EQ(out.count.total(), 1U);
  EXPECT_EQ(out.count.at<float>(0, 0), 3);
  EXPECT_NEAR(out.mean_m.at<float>(0, 0), 20 - 56.0 / 3, 1e-5);
  EXPECT_NEAR(out.top_m.at<float>(0, 0), 3, 1e-5);
  EXPECT_NEAR(out.bottom_m.at<float>(0, 0), 0, 1e-5);
}

TEST_F(LidarReturnsTest, CountsWhatLiesWithinTheFieldOfView) {
  point(32, 24, 20);
  point(0, 0, 20);
  const double corner_deg = to_degrees(std::atan(k_.ray(0, 0).head<2>().norm()));
  EXPECT_EQ(returns(0.2, 60, corner_deg - 1).within_fov, 1);
  EXPECT_EQ(returns(0.2, 60, corner_deg + 1).within_fov, 2);
  EXPECT_EQ(returns(0.2, 0.5).count.total(), 1U) << "the corner is out of reach";
}

TEST_F(LidarReturnsTest, WithoutPointsNothingIsHit) {
  const LidarReturns out = returns(0.2);
  int column = 0;
  int row = 0;
  EXPECT_FALSE(out.hit(500, -250, column, row));
  EXPECT_EQ(out.within_fov, 0);
  EXPECT_THROW(lidar_returns(cv::Mat::zeros(5, 5, CV_32FC1), k_, T_world_camera_, 0.2, 60, 17),
               std::invalid_argument);
}

}  // namespace
}  // namespace alight
