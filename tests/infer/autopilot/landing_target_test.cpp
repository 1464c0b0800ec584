#include "infer/autopilot/landing_target.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/infer/autopilot/autopilot_reports.hpp"

namespace alight {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kTolerance = 1e-5;  // of float32 at these sizes

/// The target for a site at p_imu of a vehicle somewhere in the world with this attitude.
LandingTarget target_at(const Vector3d& p_imu, const Eigen::Quaterniond& q_world_imu, const RectifiedRig& rig,
                        double radius_m = 3) {
  Eigen::Isometry3d T_world_imu = Eigen::Isometry3d::Identity();
  T_world_imu.linear() = q_world_imu.toRotationMatrix();
  T_world_imu.translation() = Vector3d(-7, 11, 40);
  TrackedSite site;
  site.circle.radius_m = radius_m;
  site.p_world = T_world_imu * p_imu;
  return landing_target(site, reports::kStart_ns, T_world_imu * rig.T_camera_imu.inverse(), rig.T_camera_imu);
}
/// As above, for a site straight below in the world.
LandingTarget target_below(double height_m, const Eigen::Quaterniond& q_world_imu) {
  return target_at(q_world_imu.conjugate() * Vector3d(0, 0, -height_m), q_world_imu,
                   reports::down_looking_rig(Vector3d::Zero()));
}

void expect_position(const LandingTarget& target, const Vector3d& p_frd_m) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(target.p_m[static_cast<std::size_t>(i)], p_frd_m[i], kTolerance) << i;
  EXPECT_NEAR(target.distance_m, p_frd_m.norm(), kTolerance);
}
void expect_orientation(const LandingTarget& target, double w, double x, double y, double z) {
  const double expected[] = {w, x, y, z};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(target.q_wxyz[i], expected[i], kTolerance) << i;
}

TEST(LandingTarget, AheadIsXLeftIsNegativeYBelowIsZ) {
  const LandingTarget target =
      target_at({3, 2, -12}, Eigen::Quaterniond::Identity(), reports::down_looking_rig());
  expect_position(target, {3, -2, 12});
  expect_orientation(target, 1, 0, 0, 0);
  EXPECT_EQ(target.frame, 12);
  EXPECT_EQ(target.type, 3);
  EXPECT_EQ(target.position_valid, 1);
}

TEST(LandingTarget, HeadingDoesNotMatter) {
  const LandingTarget target = target_at({3, 2, -12}, Eigen::Quaterniond(AngleAxisd(2.1, Vector3d::UnitZ())),
                                         reports::down_looking_rig());
  expect_position(target, {3, -2, 12});
  expect_orientation(target, 1, 0, 0, 0);
}

TEST(LandingTarget, NoseUpPutsTheGroundBelowBehind) {
  const double pitch_rad = 0.2;  // forward-left-up: a negative turn about y raises the nose
  const LandingTarget target =
      target_below(10, Eigen::Quaterniond(AngleAxisd(-pitch_rad, Vector3d::UnitY())));
  expect_position(target, {-10 * std::sin(pitch_rad), 0, 10 * std::cos(pitch_rad)});
  EXPECT_NEAR(target.angle_x_rad, 0, kTolerance);
  EXPECT_NEAR(target.angle_y_rad, pitch_rad, kTolerance);  // behind: the image's lower half
  expect_orientation(target, std::cos(pitch_rad / 2), 0, -std::sin(pitch_rad / 2), 0);
}

TEST(LandingTarget, RightSideDownPutsTheGroundBelowRight) {
  const double roll_rad = 0.3;
  const LandingTarget target = target_below(10, Eigen::Quaterniond(AngleAxisd(roll_rad, Vector3d::UnitX())));
  expect_position(target, {0, 10 * std::sin(roll_rad), 10 * std::cos(roll_rad)});
  EXPECT_NEAR(target.angle_x_rad, roll_rad, kTolerance);  // the image's right half
  EXPECT_NEAR(target.angle_y_rad, 0, kTolerance);
  expect_orientation(target, std::cos(roll_rad / 2), -std::sin(roll_rad / 2), 0, 0);
}

TEST(LandingTarget, OrientationTurnsDownInTheWorldIntoTheBody) {
  const Eigen::Quaterniond q_world_imu = AngleAxisd(1.0, Vector3d::UnitZ()) *
                                         AngleAxisd(0.25, Vector3d::UnitY()) *
                                         AngleAxisd(-0.4, Vector3d::UnitX());
  const LandingTarget target = target_below(1, q_world_imu);
  const Eigen::Quaterniond q(target.q_wxyz[0], target.q_wxyz[1], target.q_wxyz[2], target.q_wxyz[3]);
  const Vector3d down = q * Vector3d::UnitZ();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(down[i], target.p_m[static_cast<std::size_t>(i)], kTolerance) << i;
}

TEST(LandingTarget, AnglesAreTheCamerasAndPositionIsTheBodys) {
  const LandingTarget target =
      target_at({3, 2, -12}, Eigen::Quaterniond::Identity(), reports::down_looking_rig());
  // p_camera = (-2 + 0.04, -3 + 0.10, 12 - 0.12)
  EXPECT_NEAR(target.angle_x_rad, std::atan(-1.96 / 11.88), kTolerance);
  EXPECT_NEAR(target.angle_y_rad, std::atan(-2.90 / 11.88), kTolerance);
}

TEST(LandingTarget, AnglesPointWhereArduPilotExpectsThem) {
  const LandingTarget target =
      target_at({3, 2, -12}, Eigen::Quaterniond::Identity(), reports::down_looking_rig(Vector3d::Zero()));
  // Without a position ArduPilot takes the direction to be (-tan(angle_y), tan(angle_x), 1).
  EXPECT_NEAR(-std::tan(target.angle_y_rad) * target.p_m[2], target.p_m[0], kTolerance);
  EXPECT_NEAR(std::tan(target.angle_x_rad) * target.p_m[2], target.p_m[1], kTolerance);
}

TEST(LandingTarget, AForwardLookingCameraChangesTheAnglesOnly) {
  RectifiedRig rig;
  rig.T_camera_imu.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const LandingTarget target = target_at({20, 0, -5}, Eigen::Quaterniond::Identity(), rig);
  expect_position(target, {20, 0, 5});
  EXPECT_NEAR(target.angle_x_rad, 0, kTolerance);
  EXPECT_NEAR(target.angle_y_rad, std::atan(5.0 / 20.0), kTolerance);
}

TEST(LandingTarget, SizeIsTheAngleOfTheCirclesDiameter) {
  const LandingTarget target = target_at({0, 0, -10}, Eigen::Quaterniond::Identity(),
                                         reports::down_looking_rig(Vector3d::Zero()), 2.5);
  EXPECT_NEAR(target.size_x_rad, 2 * std::atan(0.25), kTolerance);
  EXPECT_EQ(target.size_y_rad, target.size_x_rad);
}

TEST(LandingTarget, TimeIsTheImagesInMicroseconds) {
  const LandingTarget target =
      target_at({0, 0, -10}, Eigen::Quaterniond::Identity(), reports::down_looking_rig());
  EXPECT_EQ(target.time_us, 1'600'000'000'123'456U);
}

}  // namespace
}  // namespace alight
