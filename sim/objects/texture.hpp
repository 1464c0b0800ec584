#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "sim/objects/triangle_mesh.hpp"

namespace alight::sim {

/// Points to be painted together, as arrays so that the noise is computed eight lanes at a time.
struct TextureBatch {
  static constexpr std::size_t kCapacity = 64;
  template <class T>
  using Lanes = std::array<T, kCapacity>;

  alignas(64) Lanes<float> u_m{};  ///< texture coordinates, metres
  alignas(64) Lanes<float> v_m{};
  alignas(64) Lanes<float> footprint_m{};  ///< width of the pixel on the surface; finer detail is left out
  alignas(64) Lanes<float> contrast{};     ///< brightness amplitude of one octave
  alignas(64) Lanes<float> fine_gain{};
  alignas(64) Lanes<std::uint32_t> seed{};
  alignas(64) Lanes<float> brightness{};  ///< result: relative deviation, mean 0
  alignas(64) Lanes<float> mix{};         ///< result: 0..1, between a material's two colours
};

/// Fills brightness and mix of the first `count` lanes: value noise anchored in the texture plane, octaves
/// from 1.2 cm to 20 m. An octave fades out where its cell comes near the footprint, so that nothing aliases.
/// Every instruction set gives the same bits.
void evaluate_noise(TextureBatch& batch, std::size_t count);

/// Diffuse linear albedo of a surface at a texture coordinate, with the drawing of its material (lanes,
/// tiles, windows, ...), each line filtered by the footprint.
Eigen::Vector3f surface_albedo(const Surface& surface, float u_m, float v_m, float footprint_m,
                               float brightness, float mix);

/// Where a point of an unframed surface lies in the texture plane: the two axes along which the facet lies
/// flattest.
void triplanar_coordinates(const Eigen::Vector3f& p_world, const Eigen::Vector3f& facet_normal, float& u_m,
                           float& v_m, std::uint32_t& plane);

}  // namespace alight::sim
