#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sim/objects/terrain_mesh.hpp"
#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"
#include "sim/site/site_plan.hpp"
#include "sim/spec/world_spec.hpp"

namespace alight::sim {

/// How things of a kind are strewn over a site. Lengths grow with a thing's scale.
struct Scatter {
  int count = 0;
  double min_scale = 1;
  double max_scale = 1;
  double clear_radius_m = 0;  ///< free ground around its middle, at scale 1
  bool takes_ground = true;   ///< what comes later keeps away
  double sink_m = 0;          ///< into the ground, at scale 1
};

/// Puts meshes on the ground of a site and marks in its plan what they take. The spec, terrain and plan
/// have to outlive it.
class ObjectPlacer {
 public:
  ObjectPlacer(const WorldSpec& spec, const Terrain& terrain, SitePlan& plan)
      : spec_(spec), terrain_(terrain), plan_(plan) {}

  /// A mesh for put() and scatter(). @returns its index
  std::size_t add_mesh(TriangleMesh mesh);
  /// A mesh that stands where it is: its coordinates are the world's.
  void add_in_place(TriangleMesh mesh);
  /// Puts a mesh on the ground, sunk into it by `sink_m`.
  void put(std::size_t mesh, const Eigen::Vector2d& at, double sink_m, double yaw_rad, double scale,
           const Eigen::Vector3f& tint_rgb = Eigen::Vector3f::Ones());
  /// Puts meshes of several kinds on free ground: small ones are many, big ones few. Those that find no ground are left
  /// out.
  void scatter(Random& random, const std::vector<std::size_t>& kinds, const Scatter& how);

  /// The point of the ground at `p`, in the world, metres.
  Eigen::Vector3f on_ground(const Eigen::Vector2d& p) const;
  /// What stands once, in world coordinates; to be added in place at the end.
  TriangleMesh& fixed() { return fixed_; }
  const Terrain& terrain() const { return terrain_; }
  SitePlan& plan() { return plan_; }

  /// What was put on the ground, to be moved out at the end.
  std::vector<TriangleMesh>& meshes() { return meshes_; }
  std::vector<Placement>& placements() { return placements_; }

 private:
  const WorldSpec& spec_;
  const Terrain& terrain_;
  SitePlan& plan_;
  TriangleMesh fixed_;
  std::vector<TriangleMesh> meshes_;
  std::vector<Placement> placements_;
};

}  // namespace alight::sim
