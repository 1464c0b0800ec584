#include "sim/spec/world_spec.hpp"

#include <algorithm>
#include <cmath>

namespace alight::sim {

WorldSpec::WorldSpec(const WorldConfig& config) : config_(config), look_(parameters(config.look)) {}

int WorldSpec::scaled(int count) const {
  const double share = config_.size_m * config_.size_m / (160.0 * 160.0);
  return count == 0 ? 0 : std::max(1, static_cast<int>(std::lround(count * share)));
}

Material WorldSpec::cover(Material material) const {
  const bool natural = material == Material::kGrass || material == Material::kDryGrass ||
                       material == Material::kSoil || material == Material::kGravel ||
                       material == Material::kRock;
  return natural && has(Hardship::kSnow) ? Material::kSnow : material;
}

Random WorldSpec::stream(BuildStep step) const {
  return Random(static_cast<std::uint64_t>(config_.seed) * 64 + static_cast<std::uint64_t>(config_.look),
                100 + static_cast<std::uint64_t>(step));
}

}  // namespace alight::sim
