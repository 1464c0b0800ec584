#include "sim/placing/open_ground.hpp"

#include <algorithm>
#include <cmath>

namespace alight::sim {

std::optional<Eigen::Vector2d> find_open(const SitePlan& plan, const std::vector<Levelling>& clearings,
                                         Random& random, double radius_m, double half_width_m) {
  constexpr int kAttempts = 30;
  if (!clearings.empty() && random.chance(0.25)) {
    const Levelling& clearing = random.pick(clearings);
    const double reach_m = std::max(0.0, clearing.margin_m - radius_m) * std::sqrt(random.uniform());
    return clearing.rect.centre + reach_m * heading(random.uniform(0, kTwoPi));
  }
  return plan.find_free(random, radius_m, half_width_m, kAttempts);
}

}  // namespace alight::sim
