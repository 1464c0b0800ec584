#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Frames (T_a_b maps a point in b to a: p_a = T_a_b * p_b; metres, radians, nanoseconds):
///   world   local East-North-Up, origin at the flight's first position fix
///   imu     body: x forward, y left, z up (REP-103)
///   lidar   x forward (boresight), y left, z up
///   camera  left camera, optical: x right, y down, z forward (REP-103 suffix rules)
///   right   right camera, optical
namespace alight {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// Between nanoseconds, which times are kept in, and seconds, rounded to the nearest.
constexpr double to_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
inline std::int64_t to_nanoseconds(double s) { return static_cast<std::int64_t>(std::llround(s * 1e9)); }

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadiansPerDegree = kPi / 180.0;
/// Between degrees, which people read, and radians, which everything else is in.
constexpr double to_radians(double deg) { return deg * kRadiansPerDegree; }
constexpr double to_degrees(double rad) { return rad / kRadiansPerDegree; }

/// True if R^T R = I and det R = 1, each within `tolerance` (files carry about six digits).
inline bool is_rotation(const Eigen::Matrix3d& R, double tolerance = 1e-3) {
  return R.allFinite() &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance &&
         std::abs(R.determinant() - 1.0) < tolerance;
}

/// The rotation nearest to R, for matrices that were rounded in a file.
inline Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R) {
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

}  // namespace alight
