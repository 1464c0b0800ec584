#include "geometry/rig/rig.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/rig/stereo_rectification.hpp"
#include "tests/geometry/rig/rig_error.hpp"

namespace alight {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

const std::string kRoot = ALIGHT_SOURCE_DIR;

/// As Kalibr writes it: no lidar, topics, overlaps.
constexpr const char* kKalibr = R"(cam0:
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.01]
  - [-1.0, 0.0, 0.0, 0.02]
  - [0.0, 0.0, -1.0, 0.03]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 0.00002]
  distortion_model: radtan
  intrinsics: [458.6, 457.3, 367.2, 248.4]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: -0.004
cam1:
  T_cam_imu:
  - [0.0, -1.0, 0.0, -0.10]
  - [-1.0, 0.0, 0.0, 0.02]
  - [0.0, 0.0, -1.0, 0.03]
  - [0.0, 0.0, 0.0, 1.0]
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 0.00002]
  distortion_model: radtan
  intrinsics: [457.6, 456.1, 379.9, 255.2]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
  timeshift_cam_imu: -0.004
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Rig, AKalibrResultIsUsableAsItIs) {
  const Rig rig = parse_rig(kKalibr, "camchain-imucam.yaml");
  EXPECT_EQ(rig.cam0.topic, "/cam0/image_raw");
  EXPECT_EQ(rig.cam0.timeshift_cam_imu_s, -0.004);
  EXPECT_EQ(rig.cam0.camera.intrinsics.cx_px, 367.2);
  EXPECT_EQ(rig.cam0.camera.distortion_model, DistortionModel::kRadtan);
  ASSERT_TRUE(rig.cam1.has_value());
  EXPECT_EQ(rig.T_cam1_cam0.translation().x(), -0.11);
  EXPECT_EQ(rig.cam0.T_camera_imu->translation(), Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_FALSE(rig.lidar0.has_value());
}

TEST(Rig, ShippedRigsLoadAndRoundTrip) {
  const Rig rig = load_rig(kRoot + "/configs/rigs/paper.yaml");
  ASSERT_TRUE(rig.lidar0.has_value());
  // The boresight is the camera's optical axis.
  EXPECT_EQ(rig.lidar0->T_camera_lidar.linear() * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  const Rig again = parse_rig(format_rig(rig), "again");
  EXPECT_EQ(format_rig(again), format_rig(rig));
  EXPECT_TRUE(again.lidar0->T_camera_lidar.isApprox(rig.lidar0->T_camera_lidar, 0));
  EXPECT_EQ(again.cam0.camera.intrinsics, rig.cam0.camera.intrinsics);
}

TEST(Rig, EveryShippedRigLoadsRectifiesAndRoundTrips) {
  int rigs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot + "/configs/rigs")) {
    const Rig rig = load_rig(entry.path());
    ++rigs;
    EXPECT_TRUE(rig.cam0.T_camera_imu.has_value()) << entry.path();
    EXPECT_TRUE(rig.lidar0.has_value()) << entry.path();
    EXPECT_EQ(format_rig(parse_rig(format_rig(rig), "again")), format_rig(rig)) << entry.path();
    EXPECT_GT(StereoRectifier(rig).rig().intrinsics.fx_px, 0) << entry.path();
    // The camera sees part of what the LiDAR sees: something ahead of the LiDAR is ahead of the camera, too.
    const Eigen::Vector3d p_camera = rig.lidar0->T_camera_lidar * Eigen::Vector3d(20, 0, 0);
    EXPECT_GT(p_camera.z(), 15) << entry.path();
  }
  EXPECT_EQ(rigs, 5);
}

TEST(Rig, RoundedRotationsBecomeRotations) {
  const Rig rig =
      parse_rig(replaced(replaced(kKalibr, "[0.0, -1.0, 0.0, 0.01]", "[0.01234, -0.99992, 0.0, 0.01]"),
                         "[-1.0, 0.0, 0.0, 0.02]", "[-0.99992, -0.01234, 0.0, 0.02]"),
                "r");
  const Eigen::Matrix3d R = rig.cam0.T_camera_imu->linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Rig, NonRotationIsRefusedWithItsPlace) {
  const std::string message = error_of(replaced(kKalibr, "[0.0, -1.0, 0.0, 0.01]", "[0.0, -1.2, 0.0, 0.01]"));
  EXPECT_THAT(message, HasSubstr("rig.yaml:3: cam0.T_cam_imu: is no rigid transform"));
  // a mirror has determinant -1
  EXPECT_THAT(error_of(replaced(kKalibr, "[0.0, -1.0, 0.0, 0.01]", "[0.0, 1.0, 0.0, 0.01]")),
              HasSubstr("is no rigid transform"));
  EXPECT_THAT(error_of(replaced(kKalibr, "[0.0, -1.0, 0.0, 0.01]", "[0.0, -1.0, 0.01]")),
              HasSubstr("is no rigid transform"));
}

TEST(Rig, OtherMistakesNameKeyAndCure) {
  EXPECT_THAT(error_of(replaced(kKalibr, "distortion_model: radtan", "distortion_model: equi")),
              HasSubstr("expected radtan, equidistant or none"));
  EXPECT_THAT(error_of(replaced(kKalibr, "camera_model: pinhole", "camera_model: omni")),
              HasSubstr("expected pinhole"));
  EXPECT_THAT(error_of(replaced(kKalibr, "[458.6, 457.3, 367.2, 248.4]", "[458.6, 457.3]")),
              HasSubstr("cam0.intrinsics: expected [fx, fy, cx, cy]"));
  EXPECT_THAT(error_of(replaced(kKalibr, "[-0.28, 0.07, 0.0002, 0.00002]", "[0.1]")), HasSubstr("4, 5 or 8"));
  EXPECT_THAT(error_of(replaced(kKalibr, "  resolution: [752, 480]\n", "")),
              HasSubstr("cam0.resolution: is missing"));
  EXPECT_THAT(error_of(replaced(kKalibr, "T_cn_cnm1", "T_cn_cnm2")), HasSubstr("did you mean \"T_cn_cnm1\""));
}

}  // namespace
}  // namespace alight
