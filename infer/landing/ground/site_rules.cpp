#include "infer/landing/ground/site_rules.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, SiteRules& c) {
  b.field("max_slope_deg", c.max_slope_deg, "steepest safe ground", between(0.1, 60));
  b.field("min_confidence", c.min_confidence, "depth with less confidence (0..1) is unknown", between(0, 1));
  b.field("min_radius_m", c.min_radius_m, "a site has to be larger than this", between(0.1, 100));
  b.field("vehicle_radius_m", c.vehicle_radius_m, "from the vehicle's middle to the tips of its propellers",
          between(0.05, 20));
  b.check("min_radius_m", c.min_radius_m >= c.vehicle_radius_m,
          "must be at least vehicle_radius_m, or the vehicle does not fit into a site");
  b.field("margin_m", c.margin_m, "taken off every radius: uncertainty of where the vehicle comes down",
          between(0, 100));
  b.section("ranking", c.ranking, "which of several sites is the best");
}

}  // namespace alight
