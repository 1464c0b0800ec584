#include "calibrate/clocks/depth_edges.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {

void bind(Binder& b, DepthEdgeConfig& c) {
  b.field("max_gap_deg", c.max_gap_deg, "beams farther apart are no neighbours", between(0.01, 10));
  b.field("min_step_m", c.min_step_m, "between the ranges of neighbours", positive());
  b.field("min_step_share", c.min_step_share, "and at least this share of the nearer range", at_least(0));
}

std::vector<LidarReturn> depth_edges(const std::vector<LidarReturn>& returns, const DepthEdgeConfig& config) {
  const float min_cosine = static_cast<float>(std::cos(to_radians(config.max_gap_deg)));
  std::vector<LidarReturn> edges;
  for (std::size_t i = 1; i < returns.size(); ++i) {
    const LidarReturn& a = returns[i - 1];
    const LidarReturn& b = returns[i];
    const float range_a_m = a.p_lidar.norm();
    const float range_b_m = b.p_lidar.norm();
    const float near_m = std::min(range_a_m, range_b_m);
    const double step_m = std::max(config.min_step_m, config.min_step_share * static_cast<double>(near_m));
    if (static_cast<double>(std::abs(range_a_m - range_b_m)) < step_m) continue;
    const Eigen::Vector3f beam_a = a.p_lidar / range_a_m;
    const Eigen::Vector3f beam_b = b.p_lidar / range_b_m;
    if (beam_a.dot(beam_b) < min_cosine) continue;
    LidarReturn edge = range_a_m < range_b_m ? a : b;
    edge.p_lidar = near_m * (beam_a + beam_b).normalized();
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace alight
