#include "geometry/rig/stereo_rectification.hpp"

#include <cmath>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/crop.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

Rig make_rig(DistortionModel model, const std::vector<double>& left, const std::vector<double>& right) {
  Rig rig;
  rig.cam0.camera = {{450, 452, 321, 198, 640, 400}, model, left};
  rig.cam1 = RigCamera{};
  rig.cam1->camera = {{447, 449, 317, 203, 640, 400}, model, right};
  rig.T_cam1_cam0.linear() = (Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(-0.006, Eigen::Vector3d::UnitX()))
                                 .toRotationMatrix();
  rig.T_cam1_cam0.translation() = Eigen::Vector3d(-0.0801, 0.0011, -0.0007);
  rig.lidar0 = RigLidar{};
  rig.lidar0->T_camera_lidar.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  return rig;
}

/// The raw pixel's value painted by its own coordinates: rectifying the picture shows where each pixel came
/// from.
cv::Mat coordinate_image(cv::Size size) {
  cv::Mat image(size, CV_32FC2);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u)
      image.at<cv::Vec2f>(v, u) = {static_cast<float>(u), static_cast<float>(v)};
  }
  return image;
}

class RectifyLens : public ::testing::TestWithParam<DistortionModel> {};

TEST_P(RectifyLens, APointLandsOnTheSameRowWithItsDisparity) {
  const Rig rig = make_rig(GetParam(), {-0.05, 0.01, 0.0005, -0.0003}, {-0.045, 0.012, -0.0004, 0.0002});
  const StereoRectifier rectifier(rig);
  EXPECT_FALSE(rectifier.is_identity());
  const RectifiedRig& rectified = rectifier.rig();
  EXPECT_NEAR(rectified.baseline_m, rig.T_cam1_cam0.translation().norm(), 1e-12);
  const cv::Mat left = rectifier.rectify_left(coordinate_image({640, 400}));
  const cv::Mat right = rectifier.rectify_right(coordinate_image({640, 400}));
  const Eigen::Matrix3d R_rectified_camera = rectified.T_camera_lidar.linear();  // the LiDAR was only shifted
  int checked = 0;
  for (double x = -3; x <= 3; x += 1) {
    for (double y = -1.5; y <= 1.5; y += 0.75) {
      const Eigen::Vector3d p_camera(x, y, 10);
      const Eigen::Vector3d p_rectified = R_rectified_camera * p_camera;
      const Eigen::Vector2d in_left = rectified.intrinsics.project(p_rectified);
      const Eigen::Vector2d in_right = rectified.intrinsics.project(rectified.T_right_camera() * p_rectified);
      EXPECT_NEAR(in_left.y(), in_right.y(), 1e-9);
      EXPECT_NEAR(in_left.x() - in_right.x(),
                  rectified.intrinsics.fx_px * rectified.baseline_m / p_rectified.z(), 1e-9);
      // The maps lead back to the raw pixels that the lenses give.
      for (const bool is_left : {true, false}) {
        const Eigen::Vector2d at = is_left ? in_left : in_right;
        const Camera& camera = is_left ? rig.cam0.camera : rig.cam1->camera;
        const Eigen::Vector2d raw =
            *camera.project(is_left ? p_camera : Eigen::Vector3d(rig.T_cam1_cam0 * p_camera));
        if (at.x() < 2 || at.y() < 2 || at.x() > 637 || at.y() > 397) continue;
        if (raw.x() < 2 || raw.y() < 2 || raw.x() > 637 || raw.y() > 397) continue;
        const cv::Mat at_map(1, 1, CV_32FC2, cv::Scalar(at.x(), at.y()));
        cv::Mat origin;
        cv::remap(is_left ? left : right, origin, at_map, cv::noArray(), cv::INTER_LINEAR);
        EXPECT_NEAR(origin.at<cv::Vec2f>(0)[0], raw.x(), 0.1);
        EXPECT_NEAR(origin.at<cv::Vec2f>(0)[1], raw.y(), 0.1);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 20);
}

INSTANTIATE_TEST_SUITE_P(Lenses, RectifyLens,
                         ::testing::Values(DistortionModel::kRadtan, DistortionModel::kEquidistant));

TEST(StereoRectifier, RectifiedImagesPassUntouched) {
  const Rig rig = load_rig(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml");
  const StereoRectifier rectifier(rig);
  EXPECT_TRUE(rectifier.is_identity());
  EXPECT_EQ(rectifier.rig().intrinsics, rig.cam0.camera.intrinsics);
  EXPECT_EQ(rectifier.rig().baseline_m, 0.08);
  const cv::Mat image(400, 640, CV_8UC3, cv::Scalar(1, 2, 3));
  EXPECT_EQ(rectifier.rectify_left(image).data, image.data);
  EXPECT_THROW(rectifier.rectify_left(cv::Mat(10, 10, CV_8UC3)), std::invalid_argument);
}

TEST(StereoRectifier, MonoRigIsOnlyUndistorted) {
  Rig rig = make_rig(DistortionModel::kRadtan, {-0.1, 0.02, 0, 0}, {});
  rig.cam1.reset();
  const StereoRectifier rectifier(rig);
  EXPECT_EQ(rectifier.rig().baseline_m, 0);
  EXPECT_FALSE(rectifier.is_identity());
  EXPECT_TRUE(rectifier.rig().T_camera_lidar.isApprox(rig.lidar0->T_camera_lidar, 0));
}

TEST(StereoRectifier, SwappedCamerasAndOddPairsAreRefused) {
  Rig rig = make_rig(DistortionModel::kRadtan, {0, 0, 0, 0}, {0, 0, 0, 0});
  rig.T_cam1_cam0.translation().x() *= -1;
  EXPECT_THROW(StereoRectifier{rig}, ConfigError);
  rig = make_rig(DistortionModel::kRadtan, {0, 0, 0, 0}, {0, 0, 0, 0});
  rig.cam1->camera.intrinsics.width_px = 320;
  EXPECT_THROW(StereoRectifier{rig}, ConfigError);
}

TEST(StereoRectifier, CropMovesThePrincipalPoint) {
  RectifiedRig rig;
  rig.intrinsics = {440, 440, 319.5, 199.5, 640, 400};
  const RectifiedRig cropped = crop(rig, centre_crop({640, 400}, {352, 352}));
  EXPECT_EQ(cropped.intrinsics.cx_px, 175.5);
  EXPECT_EQ(cropped.intrinsics.cy_px, 175.5);
}

}  // namespace
}  // namespace alight
