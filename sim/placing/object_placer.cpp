#include "sim/placing/object_placer.hpp"

#include <utility>

#include "sim/objects/shapes.hpp"

namespace alight::sim {

std::size_t ObjectPlacer::add_mesh(TriangleMesh mesh) {
  meshes_.push_back(std::move(mesh));
  return meshes_.size() - 1;
}

void ObjectPlacer::add_in_place(TriangleMesh mesh) {
  placements_.push_back({add_mesh(std::move(mesh)), Eigen::Affine3f::Identity(), Eigen::Vector3f::Ones()});
}

void ObjectPlacer::put(std::size_t mesh, const Eigen::Vector2d& at, double sink_m, double yaw_rad,
                       double scale, const Eigen::Vector3f& tint_rgb) {
  const Eigen::Vector3f position = on_ground(at) - Eigen::Vector3f(0, 0, static_cast<float>(sink_m));
  placements_.push_back(
      {mesh, place(position, static_cast<float>(yaw_rad), static_cast<float>(scale)), tint_rgb});
}

void ObjectPlacer::scatter(Random& random, const std::vector<std::size_t>& kinds, const Scatter& how) {
  constexpr int kAttempts = 12;
  for (int i = 0; i < how.count; ++i) {
    const double share = random.uniform();
    const double scale = how.min_scale + (how.max_scale - how.min_scale) * share * random.uniform();
    const auto at = plan_.find_free(random, how.clear_radius_m * scale, spec_.half_m(), kAttempts);
    const std::size_t kind = random.pick(kinds);
    const double yaw_rad = random.uniform(0, kTwoPi);
    const float shade = random.uniformf(0.75, 1.3);
    const Eigen::Vector3f tint{shade * random.uniformf(0.9, 1.15), shade, shade * random.uniformf(0.85, 1.1)};
    if (!at) continue;
    put(kind, *at, how.sink_m * scale, yaw_rad, scale, tint);
    if (how.takes_ground) plan_.occupy_disc(*at, how.clear_radius_m * scale);
  }
}

Eigen::Vector3f ObjectPlacer::on_ground(const Eigen::Vector2d& p) const {
  return Eigen::Vector3d(p.x(), p.y(), terrain_.height_m(p.x(), p.y())).cast<float>();
}

}  // namespace alight::sim
