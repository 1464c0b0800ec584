#include "sim/placing/plants.hpp"

#include <cmath>

#include "sim/objects/vegetation.hpp"

namespace alight::sim {

void plant_trees(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer) {
  constexpr int kKinds = 4;
  Random random = spec.stream(BuildStep::kTrees);
  std::vector<std::size_t> broadleaves;
  std::vector<std::size_t> conifers;
  for (int i = 0; i < kKinds; ++i) {
    PlantSurfaces s;
    s.bark = surfaces.add(Material::kBark);
    s.leaves = surfaces.add(Material::kFoliage);
    s.inner_leaves = surfaces.add(Material::kFoliage, {0.5F, 0.55F, 0.5F});
    broadleaves.push_back(placer.add_mesh(broadleaf_tree(s, random)));
    s.leaves = surfaces.add(Material::kNeedles);
    s.inner_leaves = surfaces.add(Material::kNeedles, {0.55F, 0.55F, 0.55F});
    conifers.push_back(placer.add_mesh(conifer(s, random)));
  }
  const LookParameters& look = spec.look();
  const int count = spec.scaled(look.trees);
  const int conifer_count = static_cast<int>(std::lround(count * look.conifer_share));
  constexpr double kClearRadius_m = 0.24;
  constexpr double kSink_m = 0.01;
  placer.scatter(
      random, conifers,
      {conifer_count, look.min_tree_m, look.max_tree_m * 1.2, kClearRadius_m * 0.7, true, kSink_m});
  placer.scatter(random, broadleaves,
                 {count - conifer_count, look.min_tree_m, look.max_tree_m, kClearRadius_m, true, kSink_m});
}

void plant_bushes_and_tufts(const WorldSpec& spec, SurfaceTable& surfaces, ObjectPlacer& placer) {
  constexpr int kKinds = 3;
  Random random = spec.stream(BuildStep::kSmallPlants);
  std::vector<std::size_t> bushes;
  std::vector<std::size_t> tufts;
  for (int i = 0; i < kKinds; ++i) {
    PlantSurfaces s;
    s.leaves = surfaces.add(Material::kFoliage, {1.1F, 1.05F, 0.9F});
    s.inner_leaves = surfaces.add(Material::kFoliage, {0.55F, 0.6F, 0.5F});
    bushes.push_back(placer.add_mesh(bush(s, random)));
    tufts.push_back(placer.add_mesh(tuft(surfaces.add(Material::kFoliage, {1.6F, 1.4F, 1.2F}), random)));
  }
  placer.scatter(random, bushes, {spec.scaled(spec.look().bushes), 0.7, 3.0, 0.5, true, 0.03});
  placer.scatter(random, tufts, {spec.scaled(spec.look().tufts), 0.5, 1.3, 0.3, false, 0.02});
}

}  // namespace alight::sim
