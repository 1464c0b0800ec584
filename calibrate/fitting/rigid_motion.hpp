#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace alight {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The matrix whose product with w is v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

/// The rotation of a rotation vector, radians (Rodrigues).
inline Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& w_rad) {
  const double angle = w_rad.norm();
  return angle < 1e-12 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() + skew(w_rad))
                       : Eigen::AngleAxisd(angle, w_rad / angle).toRotationMatrix();
}

/// The rotation vector of a rotation, radians, of length 0 to pi.
inline Eigen::Vector3d rotation_log(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// A motion of R^3 x SO(3): (translation [m], rotation vector [rad]).
inline Eigen::Isometry3d small_motion(const Vector6d& v) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_exp(v.tail<3>());
  T.translation() = v.head<3>();
  return T;
}

/// Its inverse: small_motion(motion_vector(T)) = T.
inline Vector6d motion_vector(const Eigen::Isometry3d& T) {
  Vector6d v;
  v << T.translation(), rotation_log(T.linear());
  return v;
}

}  // namespace alight
