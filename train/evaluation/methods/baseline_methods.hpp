#pragma once

#include <memory>

#include "foundation/binder_fwd.hpp"
#include "train/evaluation/methods/depth_method.hpp"

namespace alight {

/// Limits of the baselines; metres.
struct BaselineConfig {
  double max_depth_m = 150;       ///< farthest depth of the altitude plane
  double ip_basic_range_m = 100;  ///< IP-Basic inverts depths as this minus depth
};
void bind(Binder& b, BaselineConfig& c);

/// Level ground at the reported height (models/inputs/altitude_plane.hpp); unknown where the height is unknown or not positive.
std::unique_ptr<DepthMethod> make_altitude_plane(const BaselineConfig& config);

/// Whatever needs no training (METHOD, "Evaluation"): nearest, Delaunay linear in depth and in inverse depth, IP-Basic,
/// altitude plane. The interpolations know nothing where no point is fed.
DepthMethods make_baselines(const BaselineConfig& config);

}  // namespace alight
