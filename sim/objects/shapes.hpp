#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"

namespace alight::sim {

/// Rotation by yaw about z, uniform scale, then translation.
Eigen::Affine3f place(const Eigen::Vector3f& position, float yaw_rad, float scale = 1.F);

/// A box of the given half sizes around T's origin, without bottom.
void add_box(TriangleMesh& mesh, const Eigen::Affine3f& T, const Eigen::Vector3f& half_m,
             std::uint16_t side_surface, std::uint16_t top_surface);

/// A tapered column from a to b with open ends.
void add_column(TriangleMesh& mesh, const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a_m,
                float radius_b_m, int sides, std::uint16_t surface);

/// A unit icosphere: `subdivisions` 0 has 20 triangles, each more four times as many. Smooth normals.
TriangleMesh icosphere(int subdivisions, std::uint16_t surface);

/// Moves the vertices of a unit sphere in and out by a few sums of smooth noise and recomputes smooth
/// normals.
/// @param roughness relative amplitude
void displace(TriangleMesh& sphere, float roughness, Random& random);

/// One cross section of a strip: its middle on the ground and its size.
struct StripSection {
  Eigen::Vector3f middle;
  float bottom_width_m;
  float top_width_m;
  float height_m;
};

/// A long body on the ground along its sections: kerb, hedge, crop row, wall.
void add_strip(TriangleMesh& mesh, const std::vector<StripSection>& sections, std::uint16_t side_surface,
               std::uint16_t top_surface);

}  // namespace alight::sim
