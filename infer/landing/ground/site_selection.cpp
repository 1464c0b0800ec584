#include "infer/landing/ground/site_selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "geometry/frames.hpp"

namespace alight {

std::optional<LandingSite> circle_at(const SiteSelection& selection, const PinholeIntrinsics& intrinsics,
                                     const Eigen::Vector2d& centre_px) {
  if (selection.radius_m.empty() || !centre_px.allFinite() ||
      !intrinsics.contains(centre_px.x(), centre_px.y())) {
    return std::nullopt;
  }
  const int u = static_cast<int>(std::lround(centre_px.x()));
  const int v = static_cast<int>(std::lround(centre_px.y()));
  if (u < 0 || v < 0 || u >= intrinsics.width_px || v >= intrinsics.height_px) return std::nullopt;
  if (selection.radius_m.at<float>(v, u) <= 0) return std::nullopt;
  LandingSite site;
  site.centre_px = {u, v};
  site.depth_m = static_cast<double>(selection.level_depth_m.at<float>(v, u));
  site.radius_m = static_cast<double>(selection.radius_m.at<float>(v, u));
  site.radius_px = site.radius_m * radius_focal_px(intrinsics) / site.depth_m;
  site.p_level = intrinsics.ray(u, v) * site.depth_m;
  site.distance_m = site.p_level.head<2>().norm();
  site.slope_rad = static_cast<double>(selection.terrain.slope_rad.at<float>(v, u));
  return site;
}

void conclude(const SiteRules& rules, SiteSelection& selection) {
  if (!selection.largest) return;
  const bool wide = selection.largest->radius_m > rules.min_radius_m;
  selection.status = wide ? SiteStatus::kFound : SiteStatus::kTooSmall;
  if (!selection.found()) {
    selection.sites.clear();
    return;
  }
  for (LandingSite& site : selection.sites)
    site.score = score(site, rules.ranking, rules.min_radius_m, to_radians(rules.max_slope_deg));
  selection.largest = selection.sites.front();  // with its score
  std::stable_sort(selection.sites.begin(), selection.sites.end(),
                   [](const LandingSite& a, const LandingSite& b) { return a.score > b.score; });
}

std::string describe(const SiteSelection& selection) {
  if (selection.status == SiteStatus::kNoDepth) return "no depth";
  if (!selection.largest) return "no flat area";
  char text[64];
  std::snprintf(text, sizeof text, selection.found() ? "landing site of %.1f m" : "largest circle %.1f m",
                selection.largest->radius_m);
  return text;
}

}  // namespace alight
