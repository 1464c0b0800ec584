#include "closed_loop/landing/vehicle_contact.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/frames.hpp"

namespace alight::closed_loop {

double highest_m(const sim::SurfaceTruth& truth, const Eigen::Vector2d& middle, double radius_m) {
  constexpr double kStep_m = 0.2;
  double highest = -1e9;
  for (double y_m = -radius_m; y_m <= radius_m; y_m += kStep_m) {
    for (double x_m = -radius_m; x_m <= radius_m; x_m += kStep_m) {
      if (std::hypot(x_m, y_m) > radius_m) continue;
      const double top_m = truth.elevation_m(middle.x() + x_m, middle.y() + y_m);
      if (top_m > highest) highest = top_m;  // false for NaN
    }
  }
  return highest;
}

bool reached_from_below(const sim::Renderer& renderer, const Eigen::Vector3d& p_world, double radius_m,
                        double low_m, double t_s) {
  constexpr int kRays = 16;
  std::vector<Eigen::Vector3d> from;
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2 * kPi * i / kRays;
    from.push_back(p_world +
                   radius_m * (i % 2 == 0 ? 1 : 0.5) * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
  }
  std::vector<sim::Hit> hits;
  renderer.cast_many(from, std::vector<Eigen::Vector3d>(from.size(), -Eigen::Vector3d::UnitZ()), hits,
                     std::vector<double>(from.size(), t_s));
  return std::any_of(hits.begin(), hits.end(),
                     [&](const sim::Hit& hit) { return hit.hit && p_world.z() - hit.range_m >= low_m; });
}

}  // namespace alight::closed_loop
