#pragma once

#include "foundation/binder_fwd.hpp"

namespace alight {

/// Over which distances the depth image's derivatives are taken, and what of them makes ground unsafe (paper 3.3; t_tur).
struct DerivativesConfig {
  /// Distance between the points that a derivative compares. The paper differences neighbouring pixels; at 30 m and
  /// 440 px these are 6.8 cm apart, where 2 cm of LiDAR noise alone is 16 degrees. A fixed distance on the ground
  /// makes the answer the same at every height. Steps lower than derivative_baseline_m * tan(max_roughness), 9 cm, and
  /// bumps half as high pass.
  double derivative_baseline_m = 0.5;
  /// Side of the square that heights are averaged over first, against point noise.
  int smoothing_px = 5;
  double max_roughness_deg = 10;
  /// Point and pose noise make specks that just exceed a limit, and one speck is enough to cut a circle in half. An
  /// unsafe patch is taken for noise when it is smaller than this *and* nowhere exceeds a limit by more than
  /// speck_max_excess: a pole, a stone or a wire is far over the limit where it stands, a kerb is long. 0: off.
  double speck_max_area_m2 = 0.15;
  double speck_max_excess = 1.5;  ///< as a multiple of the limit
  /// Sides of the squares by which the safe mask is eroded, then dilated. Equal: specks and threads of safe ground
  /// vanish and no pixel becomes safe. A larger erosion keeps a distance to everything unsafe.
  int erode_px = 3;
  int dilate_px = 3;
  /// Ground below an obstacle that hangs higher than this over it is unsafe too. 0: off, the paper.
  double overhang_clearance_m = 0.5;
};
void bind(Binder& b, DerivativesConfig& c);

}  // namespace alight
