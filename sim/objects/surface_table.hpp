#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/objects/triangle_mesh.hpp"

namespace alight::sim {

/// The surfaces of a world in the making. What is added gets the next index, and a seed of it and of the table's own.
class SurfaceTable {
 public:
  explicit SurfaceTable(int seed) : seed_(static_cast<std::uint32_t>(seed)) {}

  /// A surface without a frame. @returns its index
  std::uint16_t add(Material material, const Eigen::Vector3f& tint_rgb = Eigen::Vector3f::Ones());
  /// A surface on level ground whose texture lies along `u_axis` (unit vector), from `origin`. @returns its index
  std::uint16_t add_framed(Material material, const Eigen::Vector2d& origin, const Eigen::Vector2d& u_axis,
                           double width_m, const Eigen::Vector3f& tint_rgb = Eigen::Vector3f::Ones());
  /// A surface as it is, with its own seed. @returns its index
  std::uint16_t add(const Surface& surface);

  const std::vector<Surface>& all() const { return surfaces_; }

 private:
  std::uint32_t next_seed() const;

  std::uint32_t seed_;
  std::vector<Surface> surfaces_;
};

}  // namespace alight::sim
