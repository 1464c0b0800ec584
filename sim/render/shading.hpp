#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "sim/render/ray_scene.hpp"

namespace alight::sim {

/// What camera rays see.
struct ShadedRays {
  static constexpr std::uint32_t kSky = 0xFFFFFFFFU;

  std::array<float, RayBatch::kCapacity> distance{};             ///< in lengths of the direction; 0: sky
  std::array<Eigen::Vector3f, RayBatch::kCapacity> light_rgb{};  ///< linear, before exposure
  std::array<std::uint32_t, RayBatch::kCapacity> key{};  ///< differs where object, paint or shadow change
};

/// Colours the hits of `rays`: Lambert, one sun with shadow rays, a sky dome and light thrown back by the
/// ground; leaves let some sun through. @param pixel_rad angle that a pixel covers, sets how fine a texture
/// may be
void shade(const RayScene& scene, const RayBatch& rays, float pixel_rad, ShadedRays& out);

}  // namespace alight::sim
