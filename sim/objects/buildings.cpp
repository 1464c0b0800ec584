#include "sim/objects/buildings.hpp"

#include <array>
#include <cmath>

#include "sim/objects/shapes.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr double kFooting_m = 2.0;  // walls reach into the ground

/// A building in the making: rect coordinates to world, and new surfaces.
class Builder {
 public:
  Builder(const BuildingPlan& plan, Random& random, TriangleMesh& mesh, SurfaceTable& surfaces)
      : plan_(plan), random_(random), mesh_(mesh), surfaces_(surfaces) {
    eaves_m_ = plan.storeys * kStorey_m + 0.3;
    const float shade = random.uniformf(0.75, 1.25);
    wall_tint_ = Vector3f{shade, shade * random.uniformf(0.92, 1.02), shade * random.uniformf(0.8, 1.05)};
    wall_ = plan.barn ? Material::kWood : (random.chance(0.3) ? Material::kBrick : Material::kPlaster);
  }

  void build() {
    add_walls();
    if (plan_.flat_roof) {
      add_flat_roof();
    } else {
      add_gabled_roof();
    }
  }

 private:
  Vector3f at(double u_m, double v_m, double z_m) const {
    const Eigen::Vector2d p = plan_.rect.at(u_m, v_m);
    return Eigen::Vector3d(p.x(), p.y(), plan_.base_height_m + z_m).cast<float>();
  }
  Vector3f axis(const Eigen::Vector2d& v) const {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), 0};
  }

  std::uint16_t framed(Material material, const Vector3f& tint, const Vector3f& origin, const Vector3f& u,
                       const Vector3f& v, double width_m) {
    return surfaces_.add({material, tint, true, origin, u, v, static_cast<float>(width_m), random_.next()});
  }
  std::uint16_t plain(Material material, const Vector3f& tint) {
    Surface surface;
    surface.material = material;
    surface.tint_rgb = tint;
    surface.seed = random_.next();
    return surfaces_.add(surface);
  }
  std::uint16_t wall_surface(const Vector3f& left, const Vector3f& right) {
    const Vector3f along = right - left;
    Vector3f foot = left;
    foot.z() = static_cast<float>(plan_.base_height_m);
    return framed(wall_, wall_tint_, foot, along.normalized(), Vector3f::UnitZ(),
                  plan_.barn ? 0.0 : static_cast<double>(along.norm()));
  }

  void add_walls() {
    const double u = plan_.rect.half_u_m;
    const double v = plan_.rect.half_v_m;
    const std::array<Eigen::Vector2d, 5> ring = {{{-u, -v}, {u, -v}, {u, v}, {-u, v}, {-u, -v}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3f left = at(ring[i].x(), ring[i].y(), -kFooting_m);
      const Vector3f right = at(ring[i + 1].x(), ring[i + 1].y(), -kFooting_m);
      mesh_.add_quad(left, right, at(ring[i + 1].x(), ring[i + 1].y(), eaves_m_),
                     at(ring[i].x(), ring[i].y(), eaves_m_), wall_surface(left, right));
    }
  }

  // The ridge runs along u; the roof hangs over the walls.
  void add_gabled_roof() {
    const double overhang_m = 0.45;
    const double pitch = random_.uniform(0.45, 0.95);
    const double u = plan_.rect.half_u_m + overhang_m;
    const double v = plan_.rect.half_v_m + overhang_m;
    const double ridge_m = eaves_m_ + pitch * plan_.rect.half_v_m;
    const double gutter_m = eaves_m_ - pitch * overhang_m;
    const float shade = random_.uniformf(0.7, 1.2);
    const bool grey = random_.chance(0.25);
    const Vector3f tint = grey ? Vector3f(0.55F, 1.35F, 2.1F) * shade : Vector3f(shade, shade, shade);
    const Vector3f along = axis(plan_.rect.u_axis);
    for (const int side : {-1, 1}) {
      const Vector3f gutter_left = at(-side * -u, side * v, gutter_m);
      const Vector3f gutter_right = at(-side * u, side * v, gutter_m);
      const Vector3f ridge_right = at(-side * u, 0, ridge_m);
      const Vector3f ridge_left = at(-side * -u, 0, ridge_m);
      const Vector3f down = (gutter_left - ridge_left).normalized();
      mesh_.add_quad(gutter_left, gutter_right, ridge_right, ridge_left,
                     framed(Material::kRoofTile, tint, ridge_left, along, down, 0));
      const double wall_u = side * plan_.rect.half_u_m;
      const Vector3f left = at(wall_u, -side * plan_.rect.half_v_m, eaves_m_);
      const Vector3f right = at(wall_u, side * plan_.rect.half_v_m, eaves_m_);
      mesh_.add_triangle(left, right, at(wall_u, 0, ridge_m), wall_surface(left, right));
    }
    if (plan_.barn) return;
    const std::uint16_t brick = plain(Material::kBrick, Vector3f::Ones());
    const double chimney_u = random_.uniform(-0.6, 0.6) * plan_.rect.half_u_m;
    add_box(mesh_, box_frame(chimney_u, random_.uniform(-0.8, 0.8), ridge_m), {0.35F, 0.3F, 0.9F}, brick,
            brick);
  }

  void add_flat_roof() {
    const double u = plan_.rect.half_u_m;
    const double v = plan_.rect.half_v_m;
    const float shade = random_.uniformf(0.6, 1.7);
    const std::uint16_t deck = plain(Material::kRoofFlat, Vector3f::Constant(shade));
    mesh_.add_quad(at(-u, -v, eaves_m_), at(u, -v, eaves_m_), at(u, v, eaves_m_), at(-u, v, eaves_m_), deck);
    const std::uint16_t rim = plain(Material::kConcrete, Vector3f::Constant(random_.uniformf(0.8, 1.2)));
    for (const int side : {-1, 1}) {
      const auto long_half = static_cast<float>(u);
      const auto short_half = static_cast<float>(v - 0.3);
      add_box(mesh_, box_frame(0, side * (v - 0.15), eaves_m_ + 0.2), {long_half, 0.15F, 0.3F}, rim, rim);
      add_box(mesh_, box_frame(side * (u - 0.15), 0, eaves_m_ + 0.2), {0.15F, short_half, 0.3F}, rim, rim);
    }
    const std::uint16_t metal = plain(Material::kMetal, Vector3f::Constant(1.2F));
    const int machines = 1 + random_.below(5);
    for (int i = 0; i < machines; ++i) {
      const Vector3f half{random_.uniformf(0.4, 1.3), random_.uniformf(0.4, 1.0), random_.uniformf(0.3, 0.8)};
      const double machine_u = random_.uniform(-0.7, 0.7) * u;
      const double machine_v = random_.uniform(-0.7, 0.7) * v;
      add_box(mesh_, box_frame(machine_u, machine_v, eaves_m_ + static_cast<double>(half.z())), half, metal,
              metal);
    }
  }

  Eigen::Affine3f box_frame(double u_m, double v_m, double z_m) const {
    return place(at(u_m, v_m, z_m), static_cast<float>(plan_.rect.yaw_rad()));
  }

  const BuildingPlan& plan_;
  Random& random_;
  TriangleMesh& mesh_;
  SurfaceTable& surfaces_;
  double eaves_m_ = 0;
  Vector3f wall_tint_;
  Material wall_ = Material::kPlaster;
};

}  // namespace

void add_building(const BuildingPlan& plan, Random& random, TriangleMesh& mesh, SurfaceTable& surfaces) {
  Builder(plan, random, mesh, surfaces).build();
}

}  // namespace alight::sim
