#pragma once

#include <cstdint>

#include "infer/landing/memory/elevation_grid.hpp"
#include "infer/landing/planes/plane_judge.hpp"

namespace alight {

/// Site selection on the ground as all frames together know it: each frame goes into an ElevationGrid, and planes
/// judge the grid. A hazard seen once stays one when the view has moved on, and ground outside the view counts.
class FusedSelector {
 public:
  FusedSelector(const ElevationGridConfig& grid, const PlaneJudge& judge);

  /// Adds a frame and decides. Frames must come in time order. @throws std::invalid_argument
  /// @param depth_m CV_32FC1 plane depth, 0 = unknown
  /// @param sparse_m CV_32FC1, the LiDAR returns of the frame, 0 = none; empty: not known
  /// @param frame of SiteSelector::look or select on the same depth, whose work is used again
  /// @param vouched obstacles are remembered only where returns vouch for them, as ElevationGrid::add does for a map that
  /// a network predicted
  SiteSelection update(std::int64_t t_ns, const cv::Mat& depth_m, const cv::Mat& sparse_m,
                       const Eigen::Isometry3d& T_world_camera, const SiteSelection& frame, bool vouched);

  const ElevationGrid& grid() const { return grid_; }

 private:
  ElevationGrid grid_;
  PlaneJudge judge_;
};

}  // namespace alight
