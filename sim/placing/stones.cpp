#include "sim/placing/stones.hpp"

#include "sim/objects/props.hpp"
#include "sim/placing/open_ground.hpp"

namespace alight::sim {
namespace {

std::vector<std::size_t> add_stone_meshes(int count, double max_shade, Random& random, SurfaceTable& surfaces,
                                          ObjectPlacer& placer) {
  std::vector<std::size_t> kinds;
  for (int i = 0; i < count; ++i) {
    const float shade = random.uniformf(0.7, max_shade);
    const std::uint16_t rock = surfaces.add(Material::kRock, Eigen::Vector3f::Constant(shade));
    kinds.push_back(placer.add_mesh(boulder(rock, random)));
  }
  return kinds;
}

}  // namespace

void scatter_boulders(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer) {
  Random random = spec.stream(BuildStep::kBoulders);
  const std::vector<std::size_t> kinds = add_stone_meshes(6, 1.3, random, surfaces, placer);
  const LookParameters& look = spec.look();
  placer.scatter(random, kinds, {spec.scaled(look.boulders), 0.12, look.max_boulder_m, 1.1, true, 0.2});
}

void scatter_stones(const WorldSpec& spec, const std::vector<Levelling>& clearings, SurfaceTable& surfaces,
                    ObjectPlacer& placer) {
  constexpr int kStones = 900;
  Random random = spec.stream(BuildStep::kStones);
  const std::vector<std::size_t> kinds = add_stone_meshes(4, 1.2, random, surfaces, placer);
  for (int i = 0; i < spec.scaled(kStones); ++i) {
    const double radius_m = random.uniform(0.13, 0.19);
    const auto at = find_open(placer.plan(), clearings, random, radius_m, spec.half_m());
    const std::size_t kind = random.pick(kinds);
    const double yaw_rad = random.uniform(0, kTwoPi);
    if (at) placer.put(kind, *at, -0.3 * radius_m, yaw_rad, 1.15 * radius_m);
  }
}

}  // namespace alight::sim
