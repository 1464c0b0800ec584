#include "sim/site/ground_shape.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/parallel_rows.hpp"

namespace alight::sim {
namespace {

double smooth_step(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// A height drawn to a target that holds up to `distance_m` 0 and fades out over the falloff.
double blended_m(double height_m, double target_m, double distance_m, double falloff_m) {
  const double weight = 1 - smooth_step(distance_m / falloff_m);
  return height_m + weight * (target_m - height_m);
}

double natural_height_m(const Relief& relief, const std::vector<Mound>& mounds, const Eigen::Vector2d& p) {
  double height_m = relief.height_m(p);
  for (const Mound& mound : mounds) {
    const double distance = (p - mound.centre).norm() / mound.sigma_m;
    if (distance < 4) height_m += mound.height_m * std::exp(-0.5 * distance * distance);
  }
  return height_m;
}

double with_roads_m(double height_m, const Relief& relief, const std::vector<Road>& roads,
                    const Eigen::Vector2d& p) {
  for (const Road& road : roads) {
    const Eigen::Vector2d foot = road.line.nearest(p);
    const double distance_m = (p - foot).norm() - 0.5 * road.width_m - 1.0;
    if (distance_m < 5) height_m = blended_m(height_m, relief.smooth_m(foot), distance_m, 5);
  }
  return height_m;
}

double with_levellings_m(double height_m, const std::vector<Levelling>& levellings,
                         const Eigen::Vector2d& p) {
  for (const Levelling& l : levellings) {
    const Eigen::Vector2d d = p - l.rect.centre;
    if (d.cwiseAbs().maxCoeff() > l.rect.half_u_m + l.rect.half_v_m + l.margin_m + l.falloff_m) continue;
    const double target_m = l.height_m + l.gradient.dot(d);
    height_m = blended_m(height_m, target_m, l.rect.distance_m(p) - l.margin_m, l.falloff_m);
  }
  return height_m;
}

double with_ponds_m(double height_m, const std::vector<Pond>& ponds, const Eigen::Vector2d& p) {
  constexpr double kDepth_m = 1.3;
  constexpr double kBank_m = 0.25;
  for (const Pond& pond : ponds) {
    const double share = (p - pond.centre).norm() / pond.radius_m;
    if (share > 3) continue;
    height_m = blended_m(height_m, pond.level_m + kBank_m, (share - 1) * pond.radius_m, 4);
    if (share < 1) height_m = pond.level_m + kBank_m - kDepth_m * (1 - share * share);
  }
  return height_m;
}

}  // namespace

double shaped_height_m(const Relief& relief, const SiteLayout& layout, const Eigen::Vector2d& p) {
  double height_m = natural_height_m(relief, layout.mounds, p);
  height_m = with_roads_m(height_m, relief, layout.roads, p);
  height_m = with_levellings_m(height_m, layout.clearings, p);
  height_m = with_levellings_m(height_m, layout.building_grounds, p);
  return with_ponds_m(height_m, layout.ponds, p);
}

Terrain shape_ground(double size_m, std::uint16_t cover, const Relief& relief, SiteLayout& layout) {
  Terrain terrain(size_m, cover);
  parallel_rows(0, terrain.grid_size(), [&](int row) {
    for (int column = 0; column < terrain.grid_size(); ++column) {
      const Eigen::Vector2d p(terrain.axis_m(column), terrain.axis_m(row));
      terrain.vertex_height_m(row, column) = static_cast<float>(shaped_height_m(relief, layout, p));
    }
  });
  const auto lift_m = static_cast<float>(terrain.height_m(0.0, 0.0));
  for (int row = 0; row < terrain.grid_size(); ++row) {
    for (int column = 0; column < terrain.grid_size(); ++column)
      terrain.vertex_height_m(row, column) -= lift_m;
  }
  for (Pond& pond : layout.ponds) pond.level_m -= static_cast<double>(lift_m);
  return terrain;
}

}  // namespace alight::sim
