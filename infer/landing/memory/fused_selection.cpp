#include "infer/landing/memory/fused_selection.hpp"

#include <cmath>

#include "geometry/reprojection.hpp"
#include "infer/landing/planes/plane_fit.hpp"

namespace alight {

FusedSelector::FusedSelector(const ElevationGridConfig& grid, const PlaneJudge& judge)
    : grid_(grid), judge_(judge) {}

SiteSelection FusedSelector::update(std::int64_t t_ns, const cv::Mat& depth_m, const cv::Mat& sparse_m,
                                    const Eigen::Isometry3d& T_world_camera, const SiteSelection& frame,
                                    bool vouched) {
  const ElevationGridConfig& grid = grid_.config();
  const Eigen::Vector3d p_world_camera = T_world_camera.translation();
  const LidarReturns returns =
      sparse_m.empty() ? LidarReturns() : grid_.returns_of(sparse_m, judge_.intrinsics(), T_world_camera);
  const LidarReturns* predicted_over = vouched ? &returns : nullptr;
  if (!frame.ground.empty() && std::abs(frame.ground.raster.cell_m - grid.cell_m) < 1e-9) {
    grid_.add(t_ns, frame.ground.raster, frame.ground.shape, p_world_camera, predicted_over);
  } else {  // the derivatives have no raster, and from high up its cells are larger
    const PlaneFitConfig& planes = judge_.config();
    const ElevationRaster raster =
        rasterize(depth_m, judge_.intrinsics(), T_world_camera, grid.cell_m, planes.reach_m, planes.noise_m);
    grid_.add(t_ns, raster, fit_planes(raster, planes), p_world_camera, predicted_over);
  }
  grid_.add_returns(returns, T_world_camera);
  SiteSelection out;
  out.R_level_camera = frame.R_level_camera;
  out.level_depth_m = frame.level_depth_m;  // where the maps are shown
  judge_.look(grid_.raster(), out);
  judge_.decide(grid_.hazards(out.ground.raster), level_pose(T_world_camera, out.R_level_camera), out);
  conclude(judge_.rules(), out);
  return out;
}

}  // namespace alight
