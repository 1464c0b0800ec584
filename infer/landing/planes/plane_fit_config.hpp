#pragma once

#include "foundation/binder_fwd.hpp"

namespace alight {

/// Over which ground a plane is laid, and what makes a cell of it unsafe. Metres on the ground: the answer depends neither
/// on the height of flight nor on the size of a pixel.
struct PlaneFitConfig {
  double cell_m = 0.2;    ///< side of a cell; higher up it grows with the pixels, so that none stays empty
  double radius_m = 0.6;  ///< of the disc on which a cell's plane is fitted
  double max_residual_m = 0.07;  ///< nothing on the disc may lie farther above or below the plane
  /// 1 sigma of a single depth: what noise explains of the highest and lowest points is no residual. 0: depth is perfect.
  double noise_m = 0.02;
  double reach_m = 60;  ///< ground farther away horizontally is left out
  /// Flat cells nearer to a hazard are given up: slope and residual are known to a cell's width only. The unknown needs
  /// no guard of its own, the disc keeps away from it already.
  double guard_m = 0.4;
  /// Level ground whose seen border falls away by more than this is a roof, a container or the like. 0: off.
  double platform_height_m = 1.0;
  double platform_border = 0.3;  ///< share of the border that has to fall away
  /// Air over safe ground that the image has to show: what hangs there unseen ends a descent. 0: none has to. With h
  /// over the ground only the middle of the image, (h - column_m) / h of its side, can be safe then.
  double column_m = 0;
};
void bind(Binder& b, PlaneFitConfig& c);

}  // namespace alight
