#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/rig.hpp"
#include "tests/geometry/rig/rig_error.hpp"

namespace alight {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;

constexpr const char* kLens = R"(cam0:
  camera_model: pinhole
  intrinsics: [440, 440, 319.5, 199.5]
  resolution: [640, 400]
)";

Eigen::Isometry3d pose(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy_deg) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(to_radians(rpy_deg.z()), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(to_radians(rpy_deg.y()), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(to_radians(rpy_deg.x()), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() = xyz;
  return T;
}

std::string numbers(const std::vector<double>& values) { return config_detail::write(values); }

std::string rows(const Eigen::Isometry3d& T) { return config_detail::write(matrix_rows(T)); }

/// 9 numbers by rows.
std::vector<double> flat(const Eigen::Matrix3d& R) {
  return {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
}

/// Every way to write one transform below a key.
std::vector<std::string> forms(const Eigen::Isometry3d& T, const Eigen::Vector3d& rpy_deg) {
  const Eigen::Quaterniond q(T.linear());
  const std::vector<double> m = {T.translation().x(), T.translation().y(), T.translation().z()};
  const std::vector<double> mm = {m[0] * 1e3, m[1] * 1e3, m[2] * 1e3};
  const std::vector<double> rad = {to_radians(rpy_deg.x()), to_radians(rpy_deg.y()), to_radians(rpy_deg.z())};
  Eigen::Isometry3d in_mm = T;
  in_mm.translation() *= 1e3;
  return {
      rows(T),
      "{matrix: " + rows(T) + "}",
      "{matrix: " + rows(in_mm) + ", length_unit: mm}",
      "{xyz: " + numbers(m) + ", rotation: " + numbers(flat(T.linear())) + "}",
      "{xyz: " + numbers(m) + ", quaternion_xyzw: " + numbers({q.x(), q.y(), q.z(), q.w()}) + "}",
      "{xyz: " + numbers(m) + ", rpy_deg: " + numbers({rpy_deg.x(), rpy_deg.y(), rpy_deg.z()}) + "}",
      "{xyz: " + numbers(mm) + ", rpy_rad: " + numbers(rad) + ", length_unit: mm}",
  };
}

const Eigen::Vector3d kRpy_deg(10, -20, 100);
const Eigen::Isometry3d kTransform = pose({0.1, -0.25, 0.375}, kRpy_deg);

TEST(RigForms, EveryFormOfATransformMeansTheSame) {
  for (const std::string& form : forms(kTransform, kRpy_deg)) {
    const Rig rig = parse_rig(kLens + ("  T_cam_imu: " + form + "\n"), "rig.yaml");
    ASSERT_TRUE(rig.cam0.T_camera_imu.has_value()) << form;
    EXPECT_TRUE(rig.cam0.T_camera_imu->isApprox(kTransform, 1e-12)) << form;
  }
}

TEST(RigForms, TheInverseStandsUnderTheInverseName) {
  const Rig rig = parse_rig(kLens + ("  T_imu_cam: " + rows(kTransform.inverse()) + "\n") +
                                "lidar0:\n  T_lidar_cam: " + rows(kTransform.inverse()) + "\n",
                            "rig.yaml");
  EXPECT_TRUE(rig.cam0.T_camera_imu->isApprox(kTransform, 1e-12));
  EXPECT_TRUE(rig.lidar0->T_camera_lidar.isApprox(kTransform, 1e-12));
  EXPECT_THAT(
      error_of(kLens + ("  T_imu_cam: " + rows(kTransform) + "\n  T_cam_imu: " + rows(kTransform) + "\n")),
      HasSubstr("T_imu_cam: is the inverse of T_cam_imu"));
}

TEST(RigForms, TwoMountingsTellTheThird) {
  const Eigen::Isometry3d T_imu_lidar = pose({0, 0.5, 0}, {0, 90, 0});
  const std::string cam_imu = "  T_cam_imu: " + rows(kTransform) + "\n";
  const std::string imu_lidar = "lidar0:\n  T_imu_lidar: " + rows(T_imu_lidar) + "\n";
  const std::string cam_lidar = "  T_cam_lidar: " + rows(kTransform * T_imu_lidar) + "\n";
  EXPECT_TRUE(parse_rig(kLens + cam_imu + imu_lidar, "r")
                  .lidar0->T_camera_lidar.isApprox(kTransform * T_imu_lidar, 1e-12));
  EXPECT_TRUE(parse_rig(kLens + imu_lidar + cam_lidar, "r").cam0.T_camera_imu->isApprox(kTransform, 1e-12));
  EXPECT_THAT(error_of(kLens + cam_imu + imu_lidar + cam_lidar), HasSubstr("one too many"));
  EXPECT_THAT(error_of(kLens + imu_lidar), HasSubstr("lidar0.T_cam_lidar: is missing"));
}

TEST(RigForms, TheRightCameraMayBeGivenByItsOwnMounting) {
  const std::string imu = "  T_cam_imu: " + rows(kTransform) + "\n";
  Eigen::Isometry3d T_right_imu = kTransform;
  T_right_imu.translation().x() -= 0.12;
  std::string right = kLens;
  right.replace(0, 4, "cam1");
  const Rig rig = parse_rig(kLens + imu + right + "  T_cam_imu: " + rows(T_right_imu) + "\n", "r");
  EXPECT_TRUE(rig.T_cam1_cam0.translation().isApprox(Eigen::Vector3d(-0.12, 0, 0), 1e-12));
  EXPECT_TRUE(rig.T_cam1_cam0.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_THAT(error_of(kLens + imu + right), HasSubstr("T_cn_cnm1 is missing"));
}

TEST(RigForms, MistakesNameKeyAndCure) {
  const auto error = [](const std::string& form) {
    return error_of(kLens + ("  T_cam_imu: " + form + "\n"));
  };
  EXPECT_THAT(error("{xyz: [1, 2, 3]}"), HasSubstr("one of rotation, quaternion_xyzw, rpy_deg, rpy_rad"));
  EXPECT_THAT(error("{xyz: [1, 2, 3], rpy_deg: [0, 0, 0], rpy_rad: [0, 0, 0]}"), HasSubstr("give either"));
  EXPECT_THAT(error("{xyz: [1, 2], rpy_deg: [0, 0, 0]}"),
              HasSubstr("cam0.T_cam_imu.xyz: expected 3 numbers"));
  EXPECT_THAT(error("{xyz: [1, 2, 3], quaternion_xyzw: [1, 1, 0, 0]}"), HasSubstr("length 1"));
  EXPECT_THAT(error("{xyz: [1, 2, 3], rotation: [1, 0, 0, 0, 1, 0, 0, 0, -1]}"), HasSubstr("no rotation"));
  EXPECT_THAT(error("{xyz: [1, 2, 3], rpy_deg: [0, 0, 0], length_unit: cm}"), HasSubstr("m | mm"));
  EXPECT_THAT(error("{xyz: [1, 2, 3], rpy_grad: [0, 0, 0]}"), HasSubstr("did you mean \"rpy_rad\""));
  EXPECT_THAT(error("FILL_IN"), HasSubstr("rig.yaml:5: cam0.T_cam_imu: expected"));
}

TEST(RigForms, ReadingOptionsAreKeptByTheRoundTrip) {
  const std::string text = kLens + std::string("  stamp: receive\n") +
                           "lidar0:\n  T_cam_lidar: " + rows(kTransform) +
                           "\n  point_time: moment\n  point_time_unit: us\n  point_time_base: own_clock\n"
                           "  stamp_at: end\n  scan_period_s: 0.1\n  scan_spread: clockwise\n"
                           "  scan_start_deg: 180\n  reflectivity_scale: 255\n";
  const Rig rig = parse_rig(text, "r");
  EXPECT_EQ(rig.cam0.stamp, StampSource::kReceive);
  EXPECT_EQ(rig.lidar0->stamp, StampSource::kHeader);
  const PointTiming& points = rig.lidar0->points;
  EXPECT_EQ(points.field, "moment");
  EXPECT_EQ(points.unit, PointTiming::Unit::kMicroseconds);
  EXPECT_EQ(points.base, PointTiming::Base::kOwnClock);
  EXPECT_EQ(points.stamp_at, PointTiming::StampAt::kEnd);
  EXPECT_EQ(points.scan_period_s, 0.1);
  EXPECT_EQ(points.spread, PointTiming::Spread::kClockwise);
  EXPECT_NEAR(points.scan_start_rad, kPi, 1e-12);
  EXPECT_EQ(rig.lidar0->reflectivity_scale, 255);
  EXPECT_EQ(format_rig(parse_rig(format_rig(rig), "again")), format_rig(rig));
  EXPECT_THAT(error_of(kLens + std::string("  stamp: sometimes\n")), HasSubstr("header | receive"));
}

}  // namespace
}  // namespace alight
