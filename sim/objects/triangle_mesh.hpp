#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "sim/objects/material.hpp"

namespace alight::sim {

/// How a surface is painted: its material, a colour factor and the metric frame in which its texture lives.
struct Surface {
  Material material = Material::kGrass;
  Eigen::Vector3f tint_rgb = Eigen::Vector3f::Ones();  ///< factor on the albedo
  /// Texture coordinates in metres are ((p - origin) . u_axis, (p - origin) . v_axis), p in the world.
  /// Without a frame they are the two world axes along which the triangle lies flattest.
  bool framed = false;
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f u_axis = Eigen::Vector3f::UnitX();
  Eigen::Vector3f v_axis = Eigen::Vector3f::UnitY();
  float width_m = 0;       ///< of a road (lane markings) or wall (windows); 0: no such drawing
  std::uint32_t seed = 0;  ///< offsets the noise, so that twins differ
};

/// Triangles with a shading normal a vertex and a surface a triangle.
struct TriangleMesh {
  static constexpr std::uint16_t kGroundCover = 0xFFFF;  ///< surface comes from the world's cover map

  std::vector<Eigen::Vector3f> vertices;                ///< metres
  std::vector<Eigen::Vector3f> normals;                 ///< unit length, as many as vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices
  std::vector<std::uint16_t> triangle_surfaces;         ///< index into World::surfaces() or kGroundCover

  /// Adds a triangle with vertices of its own and the flat normal (b - a) x (c - a).
  void add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                    std::uint16_t surface);
  /// Adds the quadrangle a b c d, counter-clockwise seen from outside.
  void add_quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                const Eigen::Vector3f& d, std::uint16_t surface);
  /// Adds all of `other`, moved by T.
  void append(const TriangleMesh& other, const Eigen::Affine3f& T);
};

/// A mesh put into the world; many placements may share a mesh.
struct Placement {
  std::size_t mesh = 0;  ///< index into World::meshes()
  Eigen::Affine3f T_world_mesh = Eigen::Affine3f::Identity();
  Eigen::Vector3f tint_rgb = Eigen::Vector3f::Ones();  ///< factor on the surfaces' albedo
};

}  // namespace alight::sim
