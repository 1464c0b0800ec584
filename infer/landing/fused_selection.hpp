#pragma once

#include <cstdint>

#include "infer/landing/elevation_grid.hpp"
#include "infer/landing/site_selection.hpp"

namespace alight {

/// Site selection on the ground as all frames together know it: each frame goes into an ElevationGrid, and plane_fit
/// judges the grid. A hazard seen once stays one when the view has moved on, and ground outside the view counts.
class FusedSelector {
 public:
  FusedSelector(const ElevationGridConfig& grid, const SiteSelector& selector);

  /// Adds a frame and decides. Frames must come in time order. @throws std::invalid_argument
  /// @param depth_m CV_32FC1 plane depth, 0 = unknown
  /// @param sparse_m CV_32FC1, the LiDAR returns of the frame, 0 = none; empty: not known
  /// @param frame the decision of SiteSelector::select on the same depth, whose work is used again
  SiteSelection update(std::int64_t t_ns, const cv::Mat& depth_m, const cv::Mat& sparse_m,
                       const Eigen::Isometry3d& T_world_camera, const SiteSelection& frame);

  /// The frame's decision once more, with what is remembered to stand or hang somewhere as a hazard there.
  /// @param frame of plane_fit, already given to update(). Its sites lose what they knew of a confidence.
  SiteSelection with_memory(const SiteSelection& frame, const Eigen::Isometry3d& T_world_camera) const;

  const ElevationGrid& grid() const { return grid_; }

 private:
  ElevationGrid grid_;
  SiteSelector selector_;
};

}  // namespace alight
