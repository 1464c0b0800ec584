#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "sim/world/world.hpp"

namespace alight::sim {

/// Up to 64 rays as arrays, traced eight at a time.
struct RayBatch {
  static constexpr std::size_t kCapacity = 64;
  using Lanes = std::array<float, kCapacity>;

  std::size_t count = 0;
  alignas(64) Lanes origin_x{};
  alignas(64) Lanes origin_y{};
  alignas(64) Lanes origin_z{};
  alignas(64) Lanes direction_x{};
  alignas(64) Lanes direction_y{};
  alignas(64) Lanes direction_z{};
  alignas(64) Lanes time_s{};  ///< from the start of the flight: where what moves is

  void add(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float t_s);
  Eigen::Vector3f origin(std::size_t i) const { return {origin_x[i], origin_y[i], origin_z[i]}; }
  Eigen::Vector3f direction(std::size_t i) const { return {direction_x[i], direction_y[i], direction_z[i]}; }
};

/// What a ray met.
struct RayHit {
  float distance = 0;  ///< in lengths of the direction; 0: nothing
  float u = 0;         ///< barycentric
  float v = 0;
  std::uint32_t triangle = 0;
  std::uint32_t placement = 0;  ///< of what stands still; what moves follows after the last of those
};
using RayHits = std::array<RayHit, RayBatch::kCapacity>;

/// The point that a ray hit, looked up in the world.
struct SurfacePoint {
  Eigen::Vector3f p_world = Eigen::Vector3f::Zero();
  Eigen::Vector3f facet_normal = Eigen::Vector3f::UnitZ();    ///< unit, towards the ray's origin
  Eigen::Vector3f shading_normal = Eigen::Vector3f::UnitZ();  ///< unit, same side, smooth over the mesh
  Eigen::Vector3f tint_rgb = Eigen::Vector3f::Ones();
  const Surface* surface = nullptr;
  std::uint32_t surface_index = 0;
  std::uint32_t placement = 0;
};

/// A world in Embree's bounding volume hierarchy; what moves has hierarchies of its own, into whose frames the rays are
/// taken, each at its own time. Const use from many threads is safe.
class RayScene {
 public:
  /// `world` must outlive this. @throws std::runtime_error if Embree cannot start or runs out of memory
  explicit RayScene(const World& world);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  const World& world() const { return world_; }

  /// Nearest hits of all rays. `coherent`: the rays start together and run side by side.
  void intersect(const RayBatch& rays, bool coherent, RayHits& hits) const;
  /// Whether anything lies along each ray.
  void occluded(const RayBatch& rays, std::array<bool, RayBatch::kCapacity>& blocked) const;
  SurfacePoint surface_point(const RayHit& hit, const Eigen::Vector3f& origin,
                             const Eigen::Vector3f& direction) const;

 private:
  struct Embree;

  void meet_movers(const RayBatch& rays, std::size_t first, RayHits& hits) const;
  void shade_by_movers(const RayBatch& rays, std::size_t first,
                       std::array<bool, RayBatch::kCapacity>& blocked) const;
  const Surface& cover_surface(const Eigen::Vector3f& p_world, std::uint32_t& index) const;

  const World& world_;
  std::unique_ptr<Embree> embree_;
  std::vector<Eigen::Matrix3f> normal_matrices_;  // a placement, then a mover
};

}  // namespace alight::sim
