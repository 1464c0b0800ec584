#include "infer/mission/wander_path.hpp"

#include <cmath>
#include <stdexcept>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kGoldenAngle_rad = 2.39996322972865332;

/// Length of the spiral r = a * angle from 0 to `angle`.
double arc_m(double pitch_m, double angle) {
  return 0.5 * pitch_m * (angle * std::sqrt(1 + angle * angle) + std::asinh(angle));
}

/// The inverse, by Newton's method; the length is convex in the angle, so it converges from above.
double angle_at(double pitch_m, double way_m) {
  double angle = std::sqrt(2 * way_m / pitch_m) + 1;
  for (int i = 0; i < 60; ++i) {
    const double step = (arc_m(pitch_m, angle) - way_m) / (pitch_m * std::sqrt(1 + angle * angle));
    angle -= step;
    if (std::abs(step) < 1e-12) break;
  }
  return angle > 0 ? angle : 0;
}

}  // namespace

WanderPath::WanderPath(double radius_m, double spacing_m)
    : radius_m_(radius_m), pitch_m_(spacing_m / (2 * kPi)) {
  if (!(radius_m > 0) || !(spacing_m > 0)) {
    throw std::invalid_argument("WanderPath: radius and spacing must be positive");
  }
  pass_m_ = arc_m(pitch_m_, radius_m_ / pitch_m_);
}

Eigen::Vector2d WanderPath::at(double way_m) const {
  const double pass = std::floor(way_m / pass_m_);
  const double into_m = way_m - pass * pass_m_;
  const bool outwards = std::fmod(pass, 2.0) < 0.5;
  const double angle = angle_at(pitch_m_, outwards ? into_m : pass_m_ - into_m);
  // An inward pass begins where the outward one ended and turns on in the same sense.
  const double end = radius_m_ / pitch_m_;
  const double round = std::floor(pass / 2);
  const double bearing = round * kGoldenAngle_rad + (outwards ? angle : 2 * end - angle);
  const double radius_m = std::min(pitch_m_ * angle, radius_m_);
  return radius_m * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
}

}  // namespace alight
