#pragma once

#include <array>

#include <Eigen/Geometry>
#include <ceres/jet.h>
#include <ceres/manifold.h>
#include <ceres/product_manifold.h>

namespace alight {

/// A rigid motion as a parameter block of Ceres: translation [m], then the unit quaternion x y z w. Included by source
/// files only: Ceres' headers define LOG and CHECK.
using PoseBlock = std::array<double, 7>;
using PoseManifold = ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;

/// A pose block inside a residual. T: double or ceres::Jet
template <class T>
struct PoseView {
  Eigen::Map<const Eigen::Matrix<T, 3, 1>> translation;
  Eigen::Map<const Eigen::Quaternion<T>> rotation;

  explicit PoseView(const T* block) : translation(block), rotation(block + 3) {}
  Eigen::Matrix<T, 3, 1> operator*(const Eigen::Matrix<T, 3, 1>& p) const {
    return rotation * p + translation;
  }
};

/// The parameters of a rigid motion: quaternion and translation, metres.
inline PoseBlock pose_block(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  return {T.translation().x(), T.translation().y(), T.translation().z(), q.x(), q.y(), q.z(), q.w()};
}

/// And back.
inline Eigen::Isometry3d transform_of(const PoseBlock& block) {
  const PoseView<double> pose(block.data());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.rotation.normalized().toRotationMatrix();
  T.translation() = pose.translation;
  return T;
}

}  // namespace alight
