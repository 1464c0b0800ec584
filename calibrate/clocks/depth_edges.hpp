#pragma once

#include <vector>

#include "foundation/binder_fwd.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// Where a LiDAR's ranges step.
struct DepthEdgeConfig {
  double max_gap_deg = 0.5;      ///< beams farther apart are no neighbours
  double min_step_m = 0.25;      ///< between the ranges of neighbours ...
  double min_step_share = 0.02;  ///< ... and at least this share of the nearer one
};
void bind(Binder& b, DepthEdgeConfig& c);

/// The rims of what stands in front of something: between two returns that follow each other in a packet and whose
/// ranges differ by a step, half-way between their beams, at the nearer range (Levinson and Thrun, "Automatic Online
/// Calibration of Cameras and Lasers", 2013, keep the near point itself; half-way no rim looks too narrow). In the
/// LiDAR's frame, at the nearer return's time and reflectivity.
std::vector<LidarReturn> depth_edges(const std::vector<LidarReturn>& returns, const DepthEdgeConfig& config);

}  // namespace alight
