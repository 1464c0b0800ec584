#pragma once

#include <vector>

#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"

namespace alight::sim {

/// Surfaces of things that people leave outdoors.
struct PropSurfaces {
  std::uint16_t paint = 0;
  std::uint16_t glass = 0;
  std::uint16_t rubber = 0;
  std::uint16_t metal = 0;
  std::uint16_t wood = 0;
  std::uint16_t straw = 0;
};

/// A stone of about 1 m radius around the origin.
TriangleMesh boulder(std::uint16_t surface, Random& random);
/// A passenger car, 4.4 m along x, wheels on z = 0.
TriangleMesh car(const PropSurfaces& surfaces);
/// A person who stands upright, 1.75 m.
TriangleMesh person(std::uint16_t surface);
/// A round bale lying on z = 0, 1.3 m across.
TriangleMesh bale(const PropSurfaces& surfaces);
/// A street lamp, 6.5 m, its arm along x.
TriangleMesh lamp(const PropSurfaces& surfaces);
/// Wooden masts with crossarms at the given feet and three sagging wires between them.
void add_power_line(const std::vector<Eigen::Vector3f>& feet, const PropSurfaces& surfaces,
                    TriangleMesh& mesh);

}  // namespace alight::sim
