#include "geometry/reprojection.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

const PinholeIntrinsics kWideCamera{440, 440, 80.0, 60.5, 161, 122};

Eigen::Isometry3d translation(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// Plane depth of the plane n . p = d in camera coordinates.
cv::Mat plane_depth(const PinholeIntrinsics& k, const Eigen::Vector3d& n, double d) {
  cv::Mat depth(k.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) depth.at<float>(v, u) = static_cast<float>(d / n.dot(k.ray(u, v)));
  }
  return depth;
}

TEST(ReprojectDepth, FrontoParallelPlaneMovesByItsDisparity) {
  const double depth = 440 * 0.08 / 4;  // disparity of four pixels
  const cv::Mat moved = reproject_depth(plane_depth(kWideCamera, {0, 0, 1}, depth), kWideCamera,
                                        translation(-0.08, 0, 0), kWideCamera);
  for (int u = 0; u < moved.cols; ++u) {
    EXPECT_NEAR(moved.at<float>(50, u), u < moved.cols - 4 ? depth : 0, 1e-4) << u;
  }
}

TEST(ReprojectDepth, NearestSurfaceWins) {
  cv::Mat depth(kWideCamera.size(), CV_32FC1, cv::Scalar(17.6));  // disparity 2
  depth(cv::Rect(60, 40, 20, 20)) = 4.4;                          // disparity 8
  const cv::Mat moved = reproject_depth(depth, kWideCamera, translation(-0.08, 0, 0), kWideCamera);
  EXPECT_FLOAT_EQ(moved.at<float>(50, 53), 4.4F);
  EXPECT_FLOAT_EQ(moved.at<float>(50, 71), 4.4F);
  EXPECT_EQ(moved.at<float>(50, 73), 0);  // uncovered behind the box
  EXPECT_FLOAT_EQ(moved.at<float>(50, 80), 17.6F);
}

TEST(SampleView, TrueDepthReconstructsTheOtherCamera) {
  // Texture painted on the plane z = 8: both cameras see value(x, y) of the same point.
  const auto paint = [](const PinholeIntrinsics& k, double offset_m) {
    cv::Mat image(k.size(), CV_32FC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const Eigen::Vector3d p = 8 * k.ray(u, v) + Eigen::Vector3d(offset_m, 0, 0);
        image.at<float>(v, u) = static_cast<float>(std::sin(9 * p.x()) + std::cos(7 * p.y()));
      }
    }
    return image;
  };
  const cv::Mat left = paint(kWideCamera, 0);
  const cv::Mat right = paint(kWideCamera, 0.08);
  const cv::Mat depth_right = plane_depth(kWideCamera, {0, 0, 1}, 8);
  const SampledView view = sample_view(left, kWideCamera, depth_right, kWideCamera, translation(0.08, 0, 0));
  cv::Mat difference;
  cv::absdiff(view.image, right, difference);
  EXPECT_GT(cv::countNonZero(view.valid), 150 * 120);
  // OpenCV samples at 1/32 pixel; the texture changes by up to 0.16 a pixel.
  EXPECT_LT(cv::mean(difference, view.valid)[0], 0.16 / 32);
  const SampledView wrong =
      sample_view(left, kWideCamera, depth_right * 1.3, kWideCamera, translation(0.08, 0, 0));
  cv::absdiff(wrong.image, right, difference);
  EXPECT_GT(cv::mean(difference, wrong.valid)[0], 0.05);
}

TEST(SampleView, OutsideTheSourceIsInvalid) {
  const cv::Mat image(kWideCamera.size(), CV_8UC3, cv::Scalar::all(100));
  const cv::Mat depth(kWideCamera.size(), CV_32FC1, cv::Scalar(4.4));
  const SampledView view = sample_view(image, kWideCamera, depth, kWideCamera, translation(0.08, 0, 0));
  EXPECT_EQ(view.valid.at<std::uint8_t>(5, kWideCamera.width_px - 8), 0);
  EXPECT_EQ(view.valid.at<std::uint8_t>(5, kWideCamera.width_px - 10), 255);
  const cv::Mat none = cv::Mat::zeros(kWideCamera.size(), CV_32FC1);
  EXPECT_EQ(cv::countNonZero(sample_view(image, kWideCamera, none, kWideCamera, translation(0, 0, 0)).valid),
            0);
}

class LevelView : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(LevelView, LevelGroundHasConstantDepthWhateverTheTilt) {
  const auto [roll_deg, pitch_deg, yaw_deg] = GetParam();
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  const Eigen::Matrix3d R_world_body = (Eigen::AngleAxisd(to_radians(yaw_deg), Eigen::Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(to_radians(pitch_deg), Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(to_radians(roll_deg), Eigen::Vector3d::UnitX()))
                                           .toRotationMatrix();
  const Eigen::Matrix3d R_world_camera = R_world_body * R_body_camera;
  const double height_m = 12;
  // Ground plane z_world = -height below the camera: (R^T (0,0,-1)) . p_camera = height
  const cv::Mat tilted =
      plane_depth(kWideCamera, R_world_camera.transpose() * -Eigen::Vector3d::UnitZ(), height_m);
  const Eigen::Matrix3d R_level_camera = level_rotation(R_world_camera);
  Eigen::Isometry3d T_world_camera(R_world_camera);
  T_world_camera.pretranslate(Eigen::Vector3d(3, -5, height_m));
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, R_level_camera);
  EXPECT_LT((T_world_level.linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const Eigen::Vector3d p_camera(1, -2, 9);  // one point of the world, whichever of the two looks
  EXPECT_LT((T_world_level * (R_level_camera * p_camera) - T_world_camera * p_camera).norm(), 1e-12);
  const cv::Mat level = rotate_depth(tilted, kWideCamera, R_level_camera);
  double max_error = 0;
  for (int v = 0; v < level.rows; ++v) {
    for (int u = 0; u < level.cols; ++u) {
      if (level.at<float>(v, u) > 0)
        max_error = std::max(max_error, std::abs(level.at<float>(v, u) - height_m));
    }
  }
  EXPECT_GT(cv::countNonZero(level), 0);
  EXPECT_LT(max_error, 1e-5);  // the points' own heights, whatever the pixel grid
}

INSTANTIATE_TEST_SUITE_P(Tilts, LevelView,
                         ::testing::Values(std::make_tuple(0, 0, 0), std::make_tuple(0, 0, 73),
                                           std::make_tuple(8, 0, 10), std::make_tuple(0, -9, -120),
                                           std::make_tuple(7, 6, 45)));

}  // namespace
}  // namespace alight
