#include "sim/objects/vegetation.hpp"

#include <cmath>

#include "sim/objects/shapes.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;

Vector3f random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, kTwoPi);
  const double r = std::sqrt(1 - z * z);
  return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
}

// A spray of leaves as one small quadrangle; its shading normal is the crown's, so that crowns look round.
void add_leaves(TriangleMesh& mesh, const Vector3f& centre, const Vector3f& facing,
                const Vector3f& crown_normal, float size, std::uint16_t surface, Random& random) {
  const Vector3f u = Eigen::AngleAxisf(random.uniformf(0, kTwoPi), facing) * facing.unitOrthogonal() * size;
  const Vector3f v = facing.cross(u) * random.uniformf(0.5, 1.0);
  const std::size_t first = mesh.vertices.size();
  mesh.add_quad(centre - u, centre - v, centre + u, centre + v, surface);
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) mesh.normals[i] = crown_normal;
}

struct Blob {
  Vector3f centre;
  float radius;
};

void add_blob(TriangleMesh& mesh, const Blob& blob, int sprays, float spray_size,
              const PlantSurfaces& surfaces, Random& random) {
  TriangleMesh core = icosphere(1, surfaces.inner_leaves);
  displace(core, 0.12F, random);
  mesh.append(core, place(blob.centre, 0, 0.75F * blob.radius));
  for (int i = 0; i < sprays; ++i) {
    const Vector3f outward = random_direction(random);
    const Vector3f facing = (outward + 0.8F * random_direction(random)).normalized();
    const float depth = random.uniformf(0.72, 1.08);
    const Vector3f shading = (outward + 0.45F * facing).normalized();
    add_leaves(mesh, blob.centre + outward * (blob.radius * depth), facing, shading, spray_size,
               depth > 0.85F ? surfaces.leaves : surfaces.inner_leaves, random);
  }
}

}  // namespace

TriangleMesh broadleaf_tree(const PlantSurfaces& surfaces, Random& random) {
  constexpr int kBlobs = 15;
  TriangleMesh mesh;
  const float trunk = random.uniformf(0.28, 0.4);
  const float lean = random.uniformf(-0.04, 0.04);
  const Vector3f fork(lean, -lean, trunk);
  add_column(mesh, {0, 0, -0.05F}, fork, 0.032F, 0.022F, 7, surfaces.bark);
  const float width = random.uniformf(0.26, 0.36);
  const float height = 0.5F * (1 - 0.8F * trunk);
  for (int i = 0; i < kBlobs; ++i) {
    const Vector3f outward = random_direction(random);
    const Vector3f d = outward * random.uniformf(0.45, 0.8);
    const Vector3f centre(fork.x() + d.x() * width, fork.y() + d.y() * width,
                          1 - height + d.z() * 0.85F * height);
    add_column(mesh, fork, centre, 0.014F, 0.005F, 4, surfaces.bark);
    add_blob(mesh, {centre, random.uniformf(0.36, 0.52) * width}, 75, 0.028F, surfaces, random);
  }
  return mesh;
}

TriangleMesh conifer(const PlantSurfaces& surfaces, Random& random) {
  constexpr int kWhorls = 15;
  TriangleMesh mesh;
  add_column(mesh, {0, 0, -0.05F}, {0, 0, 0.97F}, 0.02F, 0.003F, 6, surfaces.bark);
  for (int whorl = 0; whorl < kWhorls; ++whorl) {
    const float share = static_cast<float>(whorl) / (kWhorls - 1);
    const float z = 0.12F + 0.86F * share;
    const float reach = 0.22F * std::pow(1 - 0.96F * share, 0.85F);
    const int branches = 13 - whorl / 2;
    const double turn = random.uniform(0, kTwoPi);
    for (int i = 0; i < branches; ++i) {
      const double angle = turn + kTwoPi * (i + random.uniform(-0.25, 0.25)) / branches;
      const Vector3f out = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>();
      const Vector3f side(-out.y(), out.x(), 0);
      const float length = reach * random.uniformf(0.8, 1.12);
      const Vector3f root(0, 0, z + random.uniformf(-0.02, 0.02));
      const Vector3f middle = root + out * (0.55F * length) + Vector3f(0, 0, -0.10F * length);
      const Vector3f tip = root + out * length + Vector3f(0, 0, -0.42F * length);
      const Vector3f half = side * (0.20F * length + 0.004F);
      const Vector3f hang(0, 0, -0.10F * length);
      mesh.add_triangle(root, middle - half + hang, middle, surfaces.inner_leaves);
      mesh.add_triangle(root, middle, middle + half + hang, surfaces.inner_leaves);
      mesh.add_triangle(middle, middle - half + hang, tip, surfaces.leaves);
      mesh.add_triangle(middle, tip, middle + half + hang, surfaces.leaves);
      for (int k = 0; k < 4; ++k) {
        const float along = random.uniformf(0.35, 1.0);
        const float aside = random.uniformf(-0.15, 0.15);
        const Vector3f at = root + (tip - root) * along + side * aside * length;
        const Vector3f facing = (Vector3f::UnitZ() + 0.7F * random_direction(random)).normalized();
        add_leaves(mesh, at, facing, (facing + out * 0.5F).normalized(), 0.14F * length + 0.004F,
                   surfaces.leaves, random);
      }
    }
  }
  return mesh;
}

TriangleMesh bush(const PlantSurfaces& surfaces, Random& random) {
  TriangleMesh mesh;
  const int blobs = 4 + random.below(4);
  for (int i = 0; i < blobs; ++i) {
    const float radius = random.uniformf(0.16, 0.28);
    const Vector3f centre{random.uniformf(-0.3, 0.3), random.uniformf(-0.3, 0.3),
                          radius * random.uniformf(0.6, 1.3)};
    add_blob(mesh, {centre, radius}, 60, 0.05F, surfaces, random);
  }
  return mesh;
}

TriangleMesh tuft(std::uint16_t surface, Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 26; ++i) {
    const double angle = random.uniform(0, kTwoPi);
    const Vector3f out = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>();
    const Vector3f side(-out.y() * 0.03F, out.x() * 0.03F, 0);
    const Vector3f root = out * random.uniformf(0, 0.3);
    const float bend = random.uniformf(0.05, 0.3);
    const Vector3f tip = root + out * bend + Vector3f(0, 0, random.uniformf(0.25, 0.55));
    mesh.add_triangle(root - side, root + side, tip, surface);
    for (std::size_t k = mesh.normals.size() - 3; k < mesh.normals.size(); ++k) {
      mesh.normals[k] = (mesh.normals[k] * 0.4F + Vector3f::UnitZ()).normalized();
    }
  }
  return mesh;
}

}  // namespace alight::sim
