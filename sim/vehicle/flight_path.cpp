#include "sim/vehicle/flight_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/frames.hpp"
#include "sim/counter_random.hpp"

namespace alight::sim {
namespace {

/// Quintic smoothstep 6x^5 - 15x^4 + 10x^3 with its derivative and its integral from 0.
struct Blend {
  double value;
  double slope;
  double integral;
};

Blend blend(double x) {
  if (x <= 0) return {0, 0, 0};
  if (x >= 1) return {1, 0, 0.5 + (x - 1)};
  const double x3 = x * x * x;
  return {x3 * (10 + x * (-15 + 6 * x)), 30 * x * x * (1 - x) * (1 - x), x3 * x * (2.5 + x * (-3 + x))};
}

}  // namespace

FlightPath::FlightPath(const FlightStart& start, const std::vector<FlightPhase>& phases) {
  if (phases.empty()) throw std::invalid_argument("FlightPath: needs at least one phase");
  FlightStart from = start;
  for (const FlightPhase& phase : phases) {
    if (phase.duration_s <= 0 || phase.blend_s < 0 || phase.blend_s > phase.duration_s) {
      throw std::invalid_argument("FlightPath: a phase needs a duration and a blend within it");
    }
    segments_.push_back({duration_s_, phase, from});
    duration_s_ += phase.duration_s;
    const PathPoint end = evaluate(segments_.back(), duration_s_);
    from = {end.p_world, end.yaw_rad, phase.velocity_mps, phase.yaw_rate_radps};
  }
}

PathPoint FlightPath::evaluate(const Segment& segment, double t_s) {
  const double t = t_s - segment.begin_s;
  const FlightStart& from = segment.from;
  const double blend_s = segment.phase.blend_s;
  const Eigen::Vector3d change_mps = segment.phase.velocity_mps - from.velocity_mps;
  const double yaw_change = segment.phase.yaw_rate_radps - from.yaw_rate_radps;
  // Without a blend the new velocity holds at once; before a segment begins (t < 0) the old one does.
  const Blend share = blend_s > 0 ? blend(t / blend_s) : t < 0 ? Blend{0, 0, 0} : Blend{1, 0, 0};
  const double gained_s = blend_s > 0 ? share.integral * blend_s : std::max(t, 0.0);
  PathPoint point;
  point.p_world = from.p_world + from.velocity_mps * t + change_mps * gained_s;
  point.velocity_mps = from.velocity_mps + change_mps * share.value;
  if (blend_s > 0) point.acceleration_mps2 = change_mps * (share.slope / blend_s);
  point.yaw_rad = from.yaw_rad + from.yaw_rate_radps * t + yaw_change * gained_s;
  return point;
}

PathPoint FlightPath::at(double t_s) const {
  const auto after = std::upper_bound(segments_.begin(), segments_.end(), t_s,
                                      [](double t, const Segment& segment) { return t < segment.begin_s; });
  PathPoint point = evaluate(after == segments_.begin() ? segments_.front() : *std::prev(after), t_s);
  for (const Sine& sine : sway_) {
    const double angle = sine.frequency_radps * t_s + sine.phase_rad;
    // Subtracting the value at 0 leaves the flight's start where it was planned.
    point.p_world += sine.direction_m * (std::sin(angle) - std::sin(sine.phase_rad));
    point.velocity_mps += sine.direction_m * (sine.frequency_radps * std::cos(angle));
    point.acceleration_mps2 -=
        sine.direction_m * (sine.frequency_radps * sine.frequency_radps * std::sin(angle));
  }
  return point;
}

void FlightPath::add_sway(double sway_m, std::uint64_t seed) {
  if (sway_m <= 0) return;
  const CounterRandom random(seed, RandomStream::kSway);
  for (std::uint64_t i = 0; i < 6; ++i) {
    // Two sines of amplitude `sway_m` have a variance of sway_m^2.
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    direction[static_cast<int>(i % 3)] = sway_m;
    sway_.push_back({direction, to_radians(360.0) * random.uniform(2 * i, 0.15, 0.4),
                     to_radians(360.0) * random.uniform(2 * i + 1)});
  }
}

}  // namespace alight::sim
