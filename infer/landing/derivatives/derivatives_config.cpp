#include "infer/landing/derivatives/derivatives_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, DerivativesConfig& c) {
  b.field("derivative_baseline_m", c.derivative_baseline_m,
          "ground distance that slope and roughness compare", between(0.05, 10));
  b.field("smoothing_px", c.smoothing_px, "side of the averaging window, odd; 1: none", between(1, 31));
  b.check("smoothing_px", c.smoothing_px % 2 == 1, "must be odd, so that the window has a centre");
  b.field("max_roughness_deg", c.max_roughness_deg, "largest safe change of slope", between(0.1, 60));
  b.field("speck_max_area_m2", c.speck_max_area_m2, "a smaller unsafe patch may be noise; 0: none is",
          between(0, 10));
  b.field("speck_max_excess", c.speck_max_excess, "if it nowhere exceeds this multiple of a limit",
          between(1, 10));
  b.field("erode_px", c.erode_px, "side of the square that erodes the safe mask; 1: none", between(1, 99));
  b.field("dilate_px", c.dilate_px, "side of the square that dilates it again; 1: none", between(1, 99));
  b.check("dilate_px", c.dilate_px <= c.erode_px,
          "must not exceed erode_px: it would make unsafe ground safe");
  b.field("overhang_clearance_m", c.overhang_clearance_m,
          "ground below obstacles that hang higher over it is unsafe; 0: off", between(0, 100));
}

}  // namespace alight
