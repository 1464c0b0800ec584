#include "calibrate/fitting/least_squares.hpp"

#include <limits>

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>

#include <gtest/gtest.h>

#include "calibrate/fitting/pose_block.hpp"
#include "calibrate/fitting/rigid_motion.hpp"

namespace alight {
namespace {

constexpr double kShiftSigma_m = 0.02;
constexpr double kTurnSigma_rad = 0.003;

Eigen::Isometry3d measured_pose() {
  Vector6d v;
  v << 1, -2, 3, 0.5, -1.2, 0.8;
  return small_motion(v);
}

/// A pose that was measured: its translation, and its rotation by where it takes three axes.
struct MeasuredPose {
  template <class T>
  bool operator()(const T* block, T* residual) const {
    const PoseView<T> pose(block);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> shift(residual);
    shift = (pose.translation - measured_pose().translation()) / kShiftSigma_m;
    Eigen::Map<Eigen::Matrix<T, 3, 3>> axes(residual + 3);
    // A turn w moves the axes by a sum of squares of 2 |w|^2.
    axes = (pose.rotation.toRotationMatrix() - measured_pose().linear()) / (std::sqrt(2.0) * kTurnSigma_rad);
    return true;
  }
};

struct MeasuredTranslation {
  template <class T>
  bool operator()(const T* block, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> shift(residual);
    shift = PoseView<T>(block).translation - measured_pose().translation();
    return true;
  }
};

struct NotANumber {
  template <class T>
  bool operator()(const T* x, T* residual) const {
    *residual = *x * std::numeric_limits<double>::quiet_NaN();
    return true;
  }
};

TEST(LeastSquares, FindAPoseAndItsCovarianceInMetresAndRadians) {
  Vector6d off;
  off << 0.1, 0.2, -0.1, 0.3, 0.1, -0.2;
  PoseBlock pose = pose_block(measured_pose() * small_motion(off));
  ceres::Problem problem;
  problem.AddParameterBlock(pose.data(), 7, new PoseManifold);
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MeasuredPose, 12, 7>(new MeasuredPose), nullptr,
                           pose.data());
  const auto cost = minimise(problem);
  ASSERT_TRUE(cost);
  EXPECT_LT(*cost, 1e-12);
  EXPECT_TRUE(transform_of(pose).isApprox(measured_pose(), 1e-9));
  const auto C = covariance(problem, {pose.data()});
  ASSERT_TRUE(C);
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(kShiftSigma_m * kShiftSigma_m),
      Eigen::Vector3d::Constant(kTurnSigma_rad * kTurnSigma_rad);
  const Matrix6d expected = variance.asDiagonal();
  EXPECT_LT((*C - expected).cwiseAbs().maxCoeff(), 1e-6 * kTurnSigma_rad * kTurnSigma_rad);
}

TEST(LeastSquares, ADirectionThatIsFreeHasNoCovariance) {
  PoseBlock pose = pose_block(measured_pose());
  ceres::Problem problem;
  problem.AddParameterBlock(pose.data(), 7, new PoseManifold);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<MeasuredTranslation, 3, 7>(new MeasuredTranslation), nullptr,
      pose.data());
  EXPECT_FALSE(covariance(problem, {pose.data()}));
}

TEST(LeastSquares, WhatIsNoNumberHasNoMinimumAndWritesNothingToTheTerminal) {
  double x = 1;
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<NotANumber, 1, 1>(new NotANumber), nullptr, &x);
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(minimise(problem));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace alight
