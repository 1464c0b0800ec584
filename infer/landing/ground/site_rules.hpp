#pragma once

#include "foundation/binder_fwd.hpp"
#include "infer/landing/ground/site_ranking.hpp"

namespace alight {

/// What every landing site has to keep, however its ground is judged (paper 3.3; the paper's t_inc and R).
struct SiteRules {
  double max_slope_deg = 10;
  double min_confidence = 0.5;  ///< pixels with less are unknown, where a confidence is given
  double min_radius_m = 2.0;
  double vehicle_radius_m = 0.85;  ///< from its middle to the tips of its propellers
  /// Taken off every radius: where the vehicle comes down differs by so much from where it wants to.
  double margin_m = 0.0;
  SiteRankingConfig ranking;
};
void bind(Binder& b, SiteRules& c);

}  // namespace alight
