#include "sim/site/landform_layout.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

std::optional<Eigen::Vector2d> find_clearing(const SiteLayout& layout, Random& random, double radius_m,
                                             double half_width_m) {
  std::optional<Eigen::Vector2d> at;
  for (int attempt = 0; attempt < 40; ++attempt) {
    at = layout.plan.find_free(random, radius_m, half_width_m, 400);
    if (!at) break;
    const bool in_crops = std::any_of(layout.plots.begin(), layout.plots.end(), [&](const Plot& plot) {
      return plot.crop_rows && plot.rect.distance_m(*at) < radius_m;
    });
    if (!in_crops) break;
  }
  return at;
}

}  // namespace

void lay_clearings(const WorldSpec& spec, const Relief& relief, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kClearings);
  const bool small = spec.has(Hardship::kClearings);
  const bool steep = spec.has(Hardship::kSlopes);
  const int count = spec.scaled(spec.look().clearings) * (small ? 3 : 1);
  for (int i = 0; i < count; ++i) {
    const double half_width_m = (i < 2 ? 0.2 : 0.45) * spec.size_m();
    const double radius_m = small ? random.uniform(2.2, 4.0) : random.uniform(4.5, 8.0);
    const double slope = steep ? std::tan(to_radians(random.uniform(6, 14))) : random.uniform(0, 0.05);
    const double downhill = random.uniform(0, kTwoPi);
    const auto at = find_clearing(layout, random, radius_m, half_width_m);
    if (!at) continue;
    Levelling clearing;
    clearing.rect.centre = *at;
    clearing.margin_m = radius_m;
    clearing.height_m = relief.smooth_m(*at);
    clearing.gradient = slope * heading(downhill);
    layout.clearings.push_back(clearing);
    layout.plan.occupy_disc(*at, radius_m);
  }
}

void lay_ponds(const WorldSpec& spec, const Relief& relief, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kPonds);
  for (int i = 0; i < spec.scaled(spec.look().ponds); ++i) {
    const double radius_m = random.uniform(4, 9);
    const auto at = layout.plan.find_free(random, radius_m + 2, 0.42 * spec.size_m(), 300);
    if (!at) continue;
    layout.ponds.push_back({*at, radius_m, relief.smooth_m(*at) - 0.3});
    layout.plan.occupy_disc(*at, radius_m + 1);
  }
}

void lay_mounds(const WorldSpec& spec, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kMounds);
  for (int i = 0; i < spec.scaled(spec.look().mounds); ++i) {
    const double height_m = spec.look().mound_height_m * random.uniform(0.7, 1.2);
    const double sigma_m = height_m * random.uniform(1.1, 1.8);
    const auto at = layout.plan.find_free(random, 1.5 * sigma_m, 0.45 * spec.size_m(), 200);
    if (at) layout.mounds.push_back({*at, sigma_m, height_m});
  }
}

}  // namespace alight::sim
