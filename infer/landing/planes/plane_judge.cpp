#include "infer/landing/planes/plane_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/frames.hpp"
#include "infer/landing/ground/overhang.hpp"
#include "infer/landing/planes/ground_safety.hpp"
#include "infer/landing/planes/plane_fit.hpp"
#include "infer/landing/planes/shown_ground.hpp"

namespace alight {

PlaneJudge::PlaneJudge(const PlaneFitConfig& config, const SiteRules& rules,
                       const PinholeIntrinsics& intrinsics)
    : config_(config), rules_(rules), intrinsics_(intrinsics) {}

ElevationRaster PlaneJudge::raster_of(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const {
  // Cells hold at least one pixel even where the view slants: from high up they grow with the pixels.
  constexpr double kPixelsPerCell = 1.6;
  const double mean_m = cv::mean(depth_m, depth_m > 0)[0];
  const double cell_m =
      std::max(config_.cell_m, kPixelsPerCell * mean_m / std::min(intrinsics_.fx_px, intrinsics_.fy_px));
  ElevationRaster raster =
      rasterize(depth_m, intrinsics_, T_world_camera, cell_m, config_.reach_m, config_.noise_m);
  if (config_.column_m > 0 && !raster.empty())
    raster.column_seen = columns_in_view(raster, intrinsics_, T_world_camera, config_.column_m);
  return raster;
}

void PlaneJudge::look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                      SiteSelection& seen) const {
  look(raster_of(depth_m, T_world_camera), seen);
}

void PlaneJudge::look(ElevationRaster raster, SiteSelection& seen) const {
  seen.ground.raster = std::move(raster);
  if (!seen.ground.empty()) seen.ground.shape = fit_planes(seen.ground.raster, config_);
}

void PlaneJudge::decide(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
                        SiteSelection& out) const {
  out.ground = judge_ground(std::move(out.ground.raster), std::move(out.ground.shape), hazards, config_,
                            to_radians(rules_.max_slope_deg));
  show_ground(intrinsics_, T_world_level, rules_.margin_m, out);
  if (out.ground.empty()) return;
  out.status = SiteStatus::kNoFlatArea;
  const cv::Mat radius_m = cv::max(out.ground.radius_m - rules_.margin_m, 0.0);
  const double px_per_m = 1 / out.ground.raster.cell_m;
  const auto peaks = separate_peaks(radius_m, rules_.ranking.max_sites, rules_.min_radius_m,
                                    [&](const cv::Point&) { return px_per_m; });
  if (peaks.empty()) return;
  for (const cv::Point& peak : peaks) out.sites.push_back(site_on(out.ground, peak, T_world_level));
  out.largest = out.sites.front();
}

LandingSite PlaneJudge::site_on(const GroundMap& ground, const cv::Point& cell,
                                const Eigen::Isometry3d& T_world_level) const {
  LandingSite site;
  const Eigen::Vector2d centre_m = ground.raster.centre_m(cell.x, cell.y);
  site.p_world = {centre_m.x(), centre_m.y(), static_cast<double>(ground.raster.mean_m.at<float>(cell))};
  site.p_level = T_world_level.inverse() * site.p_world;
  site.depth_m = site.p_level.z();
  site.centre_px = intrinsics_.project(site.p_level);
  site.radius_m = std::max(0.0, static_cast<double>(ground.radius_m.at<float>(cell)) - rules_.margin_m);
  site.radius_px = site.radius_m * radius_focal_px(intrinsics_) / site.depth_m;
  site.distance_m = site.p_level.head<2>().norm();
  const double cell_m = ground.raster.cell_m;
  const auto tall_m = static_cast<float>(site.p_world.z() + rules_.ranking.obstacle_height_m);
  const double radius_cells = site.radius_m / cell_m;
  float gradient = 0;
  double obstacle_cells2 = std::numeric_limits<double>::max();
  for (int row = 0; row < ground.safe.rows; ++row) {
    const float* top = ground.raster.top_m.ptr<float>(row);
    const auto* known = ground.raster.known.ptr<std::uint8_t>(row);
    const float* gradients = ground.shape.gradient.ptr<float>(row);
    const double dy2 = static_cast<double>(row - cell.y) * (row - cell.y);
    for (int column = 0; column < ground.safe.cols; ++column) {
      const double distance2 = dy2 + static_cast<double>(column - cell.x) * (column - cell.x);
      if (distance2 <= radius_cells * radius_cells) gradient = std::max(gradient, gradients[column]);
      if (known[column] != 0 && top[column] > tall_m) obstacle_cells2 = std::min(obstacle_cells2, distance2);
    }
  }
  site.slope_rad = std::atan(static_cast<double>(gradient));
  site.obstacle_m = std::min(std::sqrt(obstacle_cells2) * cell_m, config_.reach_m);
  return site;
}

}  // namespace alight
