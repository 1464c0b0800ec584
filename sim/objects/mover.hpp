#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace alight::sim {

/// What something does at the end of its way.
enum class AtWaysEnd {
  kStay,  ///< stands there
  kAnew,  ///< begins anew at the way's begin, at once
  kBack,  ///< goes back, backwards
};

/// A mesh that moves over the ground on a straight way, upright, heading along it. Where it is depends on time alone.
class Mover {
 public:
  /// @param heights_m of the ground, evenly spaced from the way's begin to its end, at least two
  Mover(std::size_t mesh, const Eigen::Vector3f& tint_rgb, const Eigen::Vector2d& from,
        const Eigen::Vector2d& to, std::vector<double> heights_m);

  /// It stands at the way's begin until `begin_s` (which may be negative: it is on its way already when a flight starts).
  void set_pace(double begin_s, double speed_mps, AtWaysEnd end);

  std::size_t mesh() const { return mesh_; }  ///< index into World::meshes()
  const Eigen::Vector3f& tint_rgb() const { return tint_rgb_; }
  /// Turn from the mesh to the world, the same all the way.
  const Eigen::Matrix3f& R_world_mesh() const { return R_world_mesh_; }
  /// The mesh's origin, in the world. @param t_s from the start of the flight
  Eigen::Vector3f p_world(double t_s) const;

 private:
  std::size_t mesh_;
  Eigen::Vector3f tint_rgb_;
  Eigen::Vector2d from_;
  Eigen::Vector2d way_m_;
  double length_m_;
  std::vector<double> heights_m_;
  Eigen::Matrix3f R_world_mesh_;
  double begin_s_ = 0;
  double speed_mps_ = 0;
  AtWaysEnd end_ = AtWaysEnd::kStay;
};

}  // namespace alight::sim
