#pragma once

#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "sim/spec/world_config.hpp"
#include "sim/world/world_parts.hpp"

namespace alight::sim {

/// A place: relief, roads, fields, buildings, plants, water; as triangles with surfaces. Frame:
/// East-North-Up, metres, origin in the middle at ground height. The detailed square is |x|, |y| <= size_m /
/// 2; beyond it the ground runs on, coarse and bare, so that no camera sees the end of the world from the
/// middle.
class World {
 public:
  explicit World(const WorldConfig& config);

  /// A world of given triangles: no relief, ground_height_m() is 0.
  /// @param sun_direction unit vector from the ground to the sun
  static World from_meshes(std::vector<TriangleMesh> meshes, std::vector<Surface> surfaces, double size_m,
                           const Eigen::Vector3d& sun_direction = {0.36, 0.48, 0.8});

  const std::vector<TriangleMesh>& meshes() const { return parts_.meshes; }
  const std::vector<Placement>& placements() const { return parts_.placements; }
  const std::vector<Surface>& surfaces() const { return parts_.surfaces; }
  /// What moves, beside the placements, which stand still.
  const std::vector<Mover>& movers() const { return parts_.movers; }
  /// Adds a mesh that stands nowhere yet. @returns its index
  std::size_t add(TriangleMesh mesh);
  void add(Mover mover) { parts_.movers.push_back(std::move(mover)); }
  /// Null in a world of given triangles.
  const Terrain* terrain() const { return parts_.terrain ? &*parts_.terrain : nullptr; }

  /// Height of the bare ground (without roads' kerbs, plants, buildings), metres.
  double ground_height_m(double x_m, double y_m) const;
  /// Side of the detailed square.
  double size_m() const { return size_m_; }
  /// Unit vector from the ground to the sun.
  const Eigen::Vector3d& sun_direction() const { return sun_direction_; }
  /// Share of a clear day's light.
  float daylight() const { return daylight_; }

 private:
  World() = default;

  WorldParts parts_;
  double size_m_ = 0;
  Eigen::Vector3d sun_direction_ = Eigen::Vector3d::UnitZ();
  float daylight_ = 1;
};

}  // namespace alight::sim
