#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/camera.hpp"
#include "sim/objects/shapes.hpp"
#include "sim/render/renderer.hpp"
#include "sim/world/world.hpp"

/// Small worlds with known answers.
namespace alight::sim::test {

inline Surface surface_of(Material material) {
  Surface surface;
  surface.material = material;
  return surface;
}

/// A square of the plane z = z0 + slope * x.
inline TriangleMesh plane(float half_m, float z0_m, float slope, std::uint16_t surface) {
  const auto corner = [&](float x, float y) {
    return Eigen::Vector3f(x * half_m, y * half_m, z0_m + slope * x * half_m);
  };
  TriangleMesh mesh;
  mesh.add_quad(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1), surface);
  return mesh;
}

inline PinholeIntrinsics intrinsics() { return {220, 220, 159.5, 99.5, 320, 200}; }

/// A camera looking straight down, image right = east, image up = north.
inline Eigen::Isometry3d camera_above(double x_m, double y_m, double z_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return T;
}

}  // namespace alight::sim::test
