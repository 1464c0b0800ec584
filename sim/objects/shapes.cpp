#include "sim/objects/shapes.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "sim/value_noise.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr float kTwoPif = 6.28318530718F;
constexpr float kBuried_m = 0.4F;  // strips reach below the ground, so that bumps leave no gap under them

void set_smooth_normals(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), Vector3f::Zero());
  for (const auto& t : mesh.triangles) {
    const Vector3f& a = mesh.vertices[t[0]];
    const Vector3f normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    for (const std::uint32_t index : t) mesh.normals[index] += normal;
  }
  for (Vector3f& normal : mesh.normals) normal.normalize();
}

TriangleMesh icosahedron() {
  const float g = 0.5F * (1.F + std::sqrt(5.F));
  TriangleMesh mesh;
  for (const Vector3f& v : {Vector3f(-1, g, 0), Vector3f(1, g, 0), Vector3f(-1, -g, 0), Vector3f(1, -g, 0),
                            Vector3f(0, -1, g), Vector3f(0, 1, g), Vector3f(0, -1, -g), Vector3f(0, 1, -g),
                            Vector3f(g, 0, -1), Vector3f(g, 0, 1), Vector3f(-g, 0, -1), Vector3f(-g, 0, 1)}) {
    mesh.vertices.push_back(v.normalized());
  }
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

void subdivide(TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto key = std::minmax(a, b);
    const auto [it, is_new] = middles.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
    return it->second;
  };
  std::vector<std::array<std::uint32_t, 3>> finer;
  for (const auto& t : mesh.triangles) {
    const std::uint32_t ab = middle(t[0], t[1]);
    const std::uint32_t bc = middle(t[1], t[2]);
    const std::uint32_t ca = middle(t[2], t[0]);
    finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(finer);
}

Vector3f sideways(const std::vector<StripSection>& sections, std::size_t i) {
  const Vector3f& before = sections[i == 0 ? 0 : i - 1].middle;
  const Vector3f& after = sections[i + 1 == sections.size() ? i : i + 1].middle;
  return Vector3f(-(after.y() - before.y()), after.x() - before.x(), 0).normalized();
}

}  // namespace

Eigen::Affine3f place(const Vector3f& position, float yaw_rad, float scale) {
  return Eigen::Translation3f(position) * Eigen::AngleAxisf(yaw_rad, Vector3f::UnitZ()) *
         Eigen::Scaling(scale);
}

void add_box(TriangleMesh& mesh, const Eigen::Affine3f& T, const Vector3f& half_m, std::uint16_t side_surface,
             std::uint16_t top_surface) {
  const auto corner = [&](int x, int y, int z) {
    return Vector3f(T * Vector3f(static_cast<float>(x) * half_m.x(), static_cast<float>(y) * half_m.y(),
                                 static_cast<float>(z) * half_m.z()));
  };
  const std::array<std::pair<int, int>, 4> ring = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [x0, y0] = ring[i];
    const auto [x1, y1] = ring[(i + 1) % 4];
    mesh.add_quad(corner(x0, y0, -1), corner(x1, y1, -1), corner(x1, y1, 1), corner(x0, y0, 1), side_surface);
  }
  mesh.add_quad(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1), top_surface);
}

void add_column(TriangleMesh& mesh, const Vector3f& a, const Vector3f& b, float radius_a_m, float radius_b_m,
                int sides, std::uint16_t surface) {
  const Vector3f axis = (b - a).normalized();
  const Vector3f x = axis.unitOrthogonal();
  const Vector3f y = axis.cross(x);
  const auto rim = [&](const Vector3f& centre, float radius_m, int i) {
    const float angle = kTwoPif * static_cast<float>(i) / static_cast<float>(sides);
    return Vector3f(centre + radius_m * (std::cos(angle) * x + std::sin(angle) * y));
  };
  for (int i = 0; i < sides; ++i) {
    mesh.add_quad(rim(a, radius_a_m, i), rim(a, radius_a_m, i + 1), rim(b, radius_b_m, i + 1),
                  rim(b, radius_b_m, i), surface);
  }
}

TriangleMesh icosphere(int subdivisions, std::uint16_t surface) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) subdivide(mesh);
  mesh.normals = mesh.vertices;
  mesh.triangle_surfaces.assign(mesh.triangles.size(), surface);
  return mesh;
}

void displace(TriangleMesh& sphere, float roughness, Random& random) {
  const auto seed = random.next();
  const auto noise = [&](const Vector3f& p, double per_unit, std::uint32_t salt) {
    // Three slices of plane noise stand in for solid noise: no seam on the sphere.
    return value_noise(p.x() * per_unit, p.y() * per_unit, seed + salt) +
           value_noise(p.y() * per_unit, p.z() * per_unit, seed + salt + 1) +
           value_noise(p.z() * per_unit, p.x() * per_unit, seed + salt + 2);
  };
  for (Vector3f& vertex : sphere.vertices) {
    const double bumps = noise(vertex, 1.3, 0) + 0.5 * noise(vertex, 3.1, 10) + 0.25 * noise(vertex, 7.3, 20);
    vertex *= 1.F + roughness * static_cast<float>(bumps);
  }
  set_smooth_normals(sphere);
}

void add_strip(TriangleMesh& mesh, const std::vector<StripSection>& sections, std::uint16_t side_surface,
               std::uint16_t top_surface) {
  if (sections.size() < 2) return;
  const auto corner = [&](std::size_t i, float side, bool top) {
    const StripSection& s = sections[i];
    const Vector3f height(0, 0, top ? s.height_m : -kBuried_m);
    return Vector3f(s.middle + height +
                    sideways(sections, i) * (side * 0.5F * (top ? s.top_width_m : s.bottom_width_m)));
  };
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
    mesh.add_quad(corner(i, -1, false), corner(i + 1, -1, false), corner(i + 1, -1, true),
                  corner(i, -1, true), side_surface);
    mesh.add_quad(corner(i + 1, 1, false), corner(i, 1, false), corner(i, 1, true), corner(i + 1, 1, true),
                  side_surface);
    mesh.add_quad(corner(i, -1, true), corner(i + 1, -1, true), corner(i + 1, 1, true), corner(i, 1, true),
                  top_surface);
  }
  const std::size_t last = sections.size() - 1;
  mesh.add_quad(corner(0, 1, false), corner(0, -1, false), corner(0, -1, true), corner(0, 1, true),
                side_surface);
  mesh.add_quad(corner(last, -1, false), corner(last, 1, false), corner(last, 1, true),
                corner(last, -1, true), side_surface);
}

}  // namespace alight::sim
