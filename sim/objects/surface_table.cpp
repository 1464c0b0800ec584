#include "sim/objects/surface_table.hpp"

#include "sim/random.hpp"

namespace alight::sim {

std::uint32_t SurfaceTable::next_seed() const {
  return mix_bits(static_cast<std::uint32_t>(surfaces_.size()), seed_);
}

std::uint16_t SurfaceTable::add(const Surface& surface) {
  surfaces_.push_back(surface);
  return static_cast<std::uint16_t>(surfaces_.size() - 1);
}

std::uint16_t SurfaceTable::add(Material material, const Eigen::Vector3f& tint_rgb) {
  Surface surface;
  surface.material = material;
  surface.tint_rgb = tint_rgb;
  surface.seed = next_seed();
  return add(surface);
}

std::uint16_t SurfaceTable::add_framed(Material material, const Eigen::Vector2d& origin,
                                       const Eigen::Vector2d& u_axis, double width_m,
                                       const Eigen::Vector3f& tint_rgb) {
  const Eigen::Vector2f u = u_axis.cast<float>();
  Surface surface;
  surface.material = material;
  surface.tint_rgb = tint_rgb;
  surface.framed = true;
  surface.origin = {static_cast<float>(origin.x()), static_cast<float>(origin.y()), 0};
  surface.u_axis = {u.x(), u.y(), 0};
  surface.v_axis = {-u.y(), u.x(), 0};
  surface.width_m = static_cast<float>(width_m);
  surface.seed = next_seed();
  return add(surface);
}

}  // namespace alight::sim
