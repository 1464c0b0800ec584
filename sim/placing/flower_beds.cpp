#include "sim/placing/flower_beds.hpp"

#include <cmath>

#include "sim/objects/shapes.hpp"
#include "sim/placing/open_ground.hpp"

namespace alight::sim {
namespace {

void add_edging(const GroundRect& bed, float height_m, std::uint16_t stone, ObjectPlacer& placer) {
  constexpr double kStep_m = 0.5;
  constexpr float kWidth_m = 0.12F;
  const double u_m = bed.half_u_m;
  const double v_m = bed.half_v_m;
  const std::vector<Eigen::Vector2d> ring = {bed.at(-u_m, -v_m), bed.at(u_m, -v_m), bed.at(u_m, v_m),
                                             bed.at(-u_m, v_m), bed.at(-u_m, -v_m)};
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const Eigen::Vector2d way_m = ring[i + 1] - ring[i];
    const int steps = static_cast<int>(std::ceil(way_m.norm() / kStep_m));
    std::vector<StripSection> sections;
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2d p = ring[i] + way_m * (static_cast<double>(k) / steps);
      sections.push_back({placer.on_ground(p), kWidth_m, kWidth_m, height_m});
    }
    add_strip(placer.fixed(), sections, stone, stone);
  }
}

}  // namespace

void lay_beds(const WorldSpec& spec, const std::vector<Levelling>& clearings, SurfaceTable& surfaces,
              ObjectPlacer& placer) {
  constexpr int kBeds = 120;
  Random random = spec.stream(BuildStep::kBeds);
  const std::uint16_t stone = surfaces.add(Material::kConcrete, {0.8F, 0.8F, 0.78F});
  for (int i = 0; i < spec.scaled(kBeds); ++i) {
    GroundRect bed;
    bed.half_u_m = random.uniform(1.2, 3.0);
    bed.half_v_m = random.uniform(0.8, 1.6);
    bed.u_axis = heading(random.uniform(0, kTwoPi));
    const float height_m = random.uniformf(0.10, 0.15);
    const double radius_m = std::hypot(bed.half_u_m, bed.half_v_m);
    const auto at = find_open(placer.plan(), clearings, random, radius_m, spec.half_m());
    if (!at) continue;
    bed.centre = *at;
    placer.plan().occupy_rect(bed, 0.3);
    add_edging(bed, height_m, stone, placer);
  }
}

}  // namespace alight::sim
