#include "sim/objects/props.hpp"

#include <cmath>

#include "sim/objects/shapes.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr float kMast_m = 8.5F;
constexpr float kWireRadius_m = 0.012F;

Eigen::Affine3f shift(float x, float y, float z) { return place({x, y, z}, 0); }

void add_wire(const Vector3f& from, const Vector3f& to, std::uint16_t surface, TriangleMesh& mesh) {
  constexpr int kPieces = 10;
  const float sag_m = 0.02F * (to - from).norm();
  const auto point = [&](int i) {
    const float t = static_cast<float>(i) / kPieces;
    return Vector3f(from + (to - from) * t - Vector3f(0, 0, 4 * sag_m * t * (1 - t)));
  };
  for (int i = 0; i < kPieces; ++i)
    add_column(mesh, point(i), point(i + 1), kWireRadius_m, kWireRadius_m, 4, surface);
}

}  // namespace

TriangleMesh boulder(std::uint16_t surface, Random& random) {
  TriangleMesh mesh = icosphere(3, surface);
  displace(mesh, 0.17F, random);
  const Vector3f squash{random.uniformf(0.8, 1.2), random.uniformf(0.7, 1.0), random.uniformf(0.5, 0.85)};
  TriangleMesh result;
  result.append(mesh, Eigen::Affine3f(Eigen::Scaling(squash)));
  return result;
}

TriangleMesh car(const PropSurfaces& s) {
  TriangleMesh mesh;
  add_box(mesh, shift(0, 0, 0.58F), {2.2F, 0.88F, 0.28F}, s.paint, s.paint);
  for (const float x : {-1.35F, 1.35F}) {
    for (const float y : {-0.8F, 0.8F})
      add_box(mesh, shift(x, y, 0.31F), {0.31F, 0.11F, 0.31F}, s.rubber, s.rubber);
  }
  // Cabin: four leaning panes under a painted roof.
  const auto low = [](float x, float y) { return Vector3f(x < 0 ? -1.75F : 0.95F, y * 0.8F, 0.86F); };
  const auto high = [](float x, float y) { return Vector3f(x < 0 ? -1.15F : 0.25F, y * 0.62F, 1.42F); };
  const std::array<Eigen::Vector2f, 5> ring = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    mesh.add_quad(low(ring[i].x(), ring[i].y()), low(ring[i + 1].x(), ring[i + 1].y()),
                  high(ring[i + 1].x(), ring[i + 1].y()), high(ring[i].x(), ring[i].y()), s.glass);
  }
  mesh.add_quad(high(-1, -1), high(1, -1), high(1, 1), high(-1, 1), s.paint);
  return mesh;
}

TriangleMesh person(std::uint16_t surface) {
  constexpr int kSides = 8;
  TriangleMesh mesh;
  for (const float y : {-0.1F, 0.1F})
    add_column(mesh, {0, y, 0}, {0, y, 0.85F}, 0.07F, 0.1F, kSides, surface);
  add_column(mesh, {0, 0, 0.8F}, {0, 0, 1.45F}, 0.2F, 0.22F, kSides, surface);
  mesh.append(icosphere(1, surface), place({0, 0, 1.42F}, 0, 0.22F));  // shoulders close the body
  mesh.append(icosphere(1, surface), place({0, 0, 1.63F}, 0, 0.12F));
  return mesh;
}

TriangleMesh bale(const PropSurfaces& s) {
  constexpr float kRadius_m = 0.65F;
  constexpr int kSides = 16;
  TriangleMesh mesh;
  const Vector3f left(-0.6F, 0, kRadius_m);
  const Vector3f right(0.6F, 0, kRadius_m);
  add_column(mesh, left, right, kRadius_m, kRadius_m, kSides, s.straw);
  add_column(mesh, left, left - Vector3f(0.02F, 0, 0), kRadius_m, 0.F, kSides, s.straw);
  add_column(mesh, right, right + Vector3f(0.02F, 0, 0), kRadius_m, 0.F, kSides, s.straw);
  return mesh;
}

TriangleMesh lamp(const PropSurfaces& s) {
  TriangleMesh mesh;
  add_column(mesh, {0, 0, -0.3F}, {0, 0, 6.5F}, 0.08F, 0.05F, 8, s.metal);
  add_column(mesh, {0, 0, 6.45F}, {1.3F, 0, 6.6F}, 0.04F, 0.035F, 6, s.metal);
  add_box(mesh, shift(1.5F, 0, 6.6F), {0.3F, 0.12F, 0.06F}, s.metal, s.metal);
  return mesh;
}

void add_power_line(const std::vector<Vector3f>& feet, const PropSurfaces& s, TriangleMesh& mesh) {
  if (feet.size() < 2) return;
  const Vector3f along = (feet.back() - feet.front()).normalized();
  const Vector3f across = Vector3f(-along.y(), along.x(), 0).normalized();
  const float yaw_rad = std::atan2(across.y(), across.x());
  for (std::size_t i = 0; i < feet.size(); ++i) {
    add_column(mesh, feet[i] - Vector3f(0, 0, 0.5F), feet[i] + Vector3f(0, 0, kMast_m), 0.14F, 0.10F, 8,
               s.wood);
    add_box(mesh, place(feet[i] + Vector3f(0, 0, kMast_m - 0.3F), yaw_rad), {0.95F, 0.06F, 0.06F}, s.wood,
            s.wood);
    if (i == 0) continue;
    for (const float side : {-0.85F, 0.F, 0.85F}) {
      const Vector3f offset = across * side + Vector3f(0, 0, kMast_m - (side == 0 ? 0.F : 0.2F));
      add_wire(feet[i - 1] + offset, feet[i] + offset, s.metal, mesh);
    }
  }
}

}  // namespace alight::sim
