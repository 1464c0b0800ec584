#include "sim/sensors/livox_scan.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

constexpr double kRefractiveIndex = 1.51;
constexpr double kWedge_rad = 17.9639 * kRadiansPerDegree;
constexpr std::int64_t kPrism1_rpm = 7294;
constexpr std::int64_t kPrism2_rpm = -4664;
constexpr std::int64_t kShotsPerMinute = 60 * kNanosecondsPerSecond / kLivoxShotPeriod_ns;

/// Angle of a prism, reduced in whole numbers so that it is exact after hours too.
double prism_angle(std::int64_t rpm, std::int64_t shot) {
  const std::int64_t turns = (rpm * (shot % kLivoxPatternShots + 1)) % kShotsPerMinute;
  return to_radians(360.0) * static_cast<double>(turns) / static_cast<double>(kShotsPerMinute);
}

Eigen::Vector3d tilted_normal(double angle_rad) {
  static const double cosine = std::cos(kWedge_rad);
  static const double sine = std::sin(kWedge_rad);
  return {-cosine, sine * std::cos(angle_rad), sine * std::sin(angle_rad)};
}

/// Snell's law for unit vectors; `normal` points against the beam, `ratio` is the index before over the one
/// behind.
Eigen::Vector3d refract(const Eigen::Vector3d& beam, const Eigen::Vector3d& normal, double ratio) {
  const double cosine = -normal.dot(beam);
  const double inner = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  return ratio * beam + (ratio * cosine - std::sqrt(inner)) * normal;
}

}  // namespace

Eigen::Vector3d livox_direction(std::int64_t shot) {
  const Eigen::Vector3d flat = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d exit_1 = tilted_normal(prism_angle(kPrism1_rpm, shot));
  const Eigen::Vector3d entry_2 = tilted_normal(prism_angle(kPrism2_rpm, shot) + to_radians(180.0));
  // The flat entry of prism 1 is met at a right angle and bends nothing.
  Eigen::Vector3d beam = refract(Eigen::Vector3d::UnitX(), exit_1, kRefractiveIndex);
  beam = refract(beam, entry_2, 1.0 / kRefractiveIndex);
  return refract(beam, flat, kRefractiveIndex).normalized();
}

}  // namespace alight::sim
