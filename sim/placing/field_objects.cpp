#include "sim/placing/field_objects.hpp"

#include "sim/objects/props.hpp"
#include "sim/objects/shapes.hpp"

namespace alight::sim {
namespace {

void grow_row(const WorldSpec& spec, const GroundRect& field, double v_m, std::uint16_t leaves,
              Random& random, ObjectPlacer& placer) {
  constexpr double kPlant_m = 0.4;
  std::vector<StripSection> sections;
  const auto end_row = [&] {
    add_strip(placer.fixed(), sections, leaves, leaves);
    sections.clear();
  };
  for (double u_m = -field.half_u_m + 0.5; u_m < field.half_u_m - 0.5; u_m += kPlant_m) {
    const Eigen::Vector2d p = field.at(u_m, v_m + random.uniform(-0.05, 0.05));
    const float height_m = random.uniformf(0.3, 0.55);
    const float top_m = random.uniformf(0.08, 0.25);
    if (spec.is_outside(p) || !placer.plan().is_free(p, 0.3)) {
      end_row();
    } else {
      sections.push_back({placer.on_ground(p), 0.48F, top_m, height_m});
    }
  }
  end_row();
}

}  // namespace

void grow_crops(const WorldSpec& spec, const std::vector<Plot>& plots, SurfaceTable& surfaces,
                ObjectPlacer& placer) {
  constexpr double kRowDistance_m = 0.75;
  Random random = spec.stream(BuildStep::kCrops);
  const std::uint16_t leaves = surfaces.add(Material::kCrop);
  for (const Plot& plot : plots) {
    if (!plot.crop_rows) continue;
    for (double v_m = -plot.rect.half_v_m + 0.6; v_m < plot.rect.half_v_m - 0.5; v_m += kRowDistance_m) {
      grow_row(spec, plot.rect, v_m, leaves, random, placer);
    }
  }
}

void lay_bales(const WorldSpec& spec, Random& random, SurfaceTable& surfaces, ObjectPlacer& placer) {
  PropSurfaces s;
  // Straw on the ground is no ground: as wood it does not bear a vehicle.
  s.straw = surfaces.add(Material::kWood, {1.5F, 1.35F, 1.2F});
  const std::size_t mesh = placer.add_mesh(bale(s));
  placer.scatter(random, {mesh}, {spec.scaled(spec.look().bales), 0.95, 1.05, 1.2, true, 0.03});
}

}  // namespace alight::sim
