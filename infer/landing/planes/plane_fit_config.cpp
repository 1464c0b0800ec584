#include "infer/landing/planes/plane_fit_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, PlaneFitConfig& c) {
  b.field("cell_m", c.cell_m, "side of a ground cell", between(0.05, 2));
  b.field("radius_m", c.radius_m, "of the disc on which a cell's plane is fitted", between(0.05, 5));
  b.field("max_residual_m", c.max_residual_m, "nothing on the disc may lie farther from its plane",
          between(0.01, 2));
  b.field("noise_m", c.noise_m, "1 sigma of a single depth, which is no residual; 0: none", between(0, 1));
  b.field("reach_m", c.reach_m, "ground farther away horizontally is left out", between(5, 500));
  b.check("radius_m", c.radius_m >= c.cell_m, "must be at least cell_m, or no plane can be fitted");
  b.check("reach_m", c.reach_m <= 1000 * c.cell_m, "must be at most 1000 cells");
  b.field("guard_m", c.guard_m, "safe ground nearer to unsafe ground is given up", between(0, 5));
  b.field("platform_height_m", c.platform_height_m,
          "flat ground whose border falls away by more is a roof; 0: off", between(0, 100));
  b.field("platform_border", c.platform_border, "share of the border that has to fall away",
          between(0.05, 1));
  b.field("column_m", c.column_m, "air over safe ground that has to be in view; 0: none", between(0, 50));
}

}  // namespace alight
