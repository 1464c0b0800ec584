#include "infer/landing/site_selector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/derivatives/derivative_safety.hpp"
#include "infer/landing/derivatives/measure_terrain.hpp"
#include "infer/landing/ground/free_radius.hpp"
#include "infer/landing/ground/overhang.hpp"
#include "infer/landing/planes/ground_safety.hpp"
#include "infer/landing/planes/plane_fit.hpp"

namespace alight {
namespace {

/// Mean confidence over a site, as the camera itself sees it.
double confidence_on(const LandingSite& site, const cv::Mat& confidence,
                     const Eigen::Matrix3d& R_level_camera, const PinholeIntrinsics& intrinsics) {
  const Eigen::Vector3d p_camera = R_level_camera.transpose() * site.p_level;
  const Eigen::Vector2d px = intrinsics.project(p_camera);
  cv::Mat circle = cv::Mat::zeros(confidence.size(), CV_8UC1);
  cv::circle(circle, {static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y()))},
             static_cast<int>(site.radius_m * intrinsics.fx_px / p_camera.z()), cv::Scalar(255), cv::FILLED);
  return cv::countNonZero(circle) > 0 ? cv::mean(confidence, circle)[0] : 0.0;
}

}  // namespace

void bind(Binder& b, SiteSelectionConfig& c) {
  b.choice("method", c.method,
           {{"plane_fit", LandingMethod::kPlaneFit}, {"derivatives", LandingMethod::kDerivatives}},
           "plane_fit: planes on discs of ground, in metres; derivatives: of the depth image, the paper's");
  b.section_of("method", "plane_fit", c.plane_fit, "how planes judge ground");
  b.section_of("method", "derivatives", c.derivatives, "how derivatives judge ground");
  b.field("max_slope_deg", c.max_slope_deg, "steepest safe ground", between(0.1, 60));
  b.field("min_confidence", c.min_confidence, "depth with less confidence (0..1) is unknown", between(0, 1));
  b.field("min_radius_m", c.min_radius_m, "a site has to be larger than this", between(0.1, 100));
  b.field("vehicle_radius_m", c.vehicle_radius_m, "from the vehicle's middle to the tips of its propellers",
          between(0.05, 20));
  b.check("min_radius_m", c.min_radius_m >= c.vehicle_radius_m,
          "must be at least vehicle_radius_m, or the vehicle does not fit into a site");
  b.field("margin_m", c.margin_m, "taken off every radius: uncertainty of where the vehicle comes down",
          between(0, 100));
  b.section("ranking", c.ranking, "which of several sites is the best");
}

SiteSelector::SiteSelector(const SiteSelectionConfig& config, const PinholeIntrinsics& intrinsics)
    : config_(config), intrinsics_(intrinsics) {}

/// The longer one makes the smaller circle.
double SiteSelector::focal_px() const { return std::max(intrinsics_.fx_px, intrinsics_.fy_px); }

ElevationRaster SiteSelector::raster_of(const cv::Mat& depth_m,
                                        const Eigen::Isometry3d& T_world_camera) const {
  // Cells hold at least one pixel even where the view slants: from high up they grow with the pixels.
  constexpr double kPixelsPerCell = 1.6;
  const double mean_m = cv::mean(depth_m, depth_m > 0)[0];
  const double cell_m = std::max(config_.plane_fit.cell_m,
                                 kPixelsPerCell * mean_m / std::min(intrinsics_.fx_px, intrinsics_.fy_px));
  ElevationRaster raster = rasterize(depth_m, intrinsics_, T_world_camera, cell_m, config_.plane_fit.reach_m,
                                     config_.plane_fit.noise_m);
  if (config_.plane_fit.column_m > 0 && !raster.empty())
    raster.column_seen = columns_in_view(raster, intrinsics_, T_world_camera, config_.plane_fit.column_m);
  return raster;
}

SiteSelection SiteSelector::select(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                                   const cv::Mat& confidence) const {
  cv::Mat trusted_m = depth_m;
  if (!confidence.empty()) {
    if (confidence.type() != CV_32FC1 || confidence.size() != depth_m.size())
      throw std::invalid_argument("SiteSelector: confidence must be CV_32FC1 of the depth's size");
    trusted_m = depth_m.clone();
    trusted_m.setTo(0, confidence < config_.min_confidence);
  }
  return decide(look(trusted_m, T_world_camera), {}, T_world_camera, confidence);
}

SiteSelection SiteSelector::select(const cv::Mat& depth_m, const Eigen::Matrix3d& R_world_camera) const {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = R_world_camera;
  return select(depth_m, T_world_camera);
}

SiteSelection SiteSelector::look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const {
  SiteSelection out;
  // 2) What a camera with roll and pitch zero sees.
  out.R_level_camera = level_rotation(T_world_camera.linear());
  out.level_depth_m = rotate_depth(depth_m, intrinsics_, out.R_level_camera);
  if (config_.method == LandingMethod::kPlaneFit) {
    out.ground.raster = raster_of(depth_m, T_world_camera);
    if (!out.ground.empty()) out.ground.shape = fit_planes(out.ground.raster, config_.plane_fit);
  }
  return out;
}

SiteSelection SiteSelector::decide(SiteSelection seen, const cv::Mat& hazards,
                                   const Eigen::Isometry3d& T_world_camera, const cv::Mat& confidence) const {
  SiteSelection out = std::move(seen);
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, out.R_level_camera);
  // 3) Slope and roughness. 4) Circles, in metres: over several heights the largest in pixels may be another one.
  if (config_.method == LandingMethod::kPlaneFit) {
    decide_by_planes(hazards, T_world_level, out);
  } else {
    decide_by_derivatives(T_world_level, out);
  }
  if (!confidence.empty()) {
    for (LandingSite& site : out.sites)
      site.confidence = confidence_on(site, confidence, out.R_level_camera, intrinsics_);
  }
  conclude(out);
  return out;
}

SiteSelection SiteSelector::judge(ElevationRaster raster, const cv::Mat& hazards,
                                  const cv::Mat& level_depth_m,
                                  const Eigen::Isometry3d& T_world_camera) const {
  SiteSelection out;
  out.R_level_camera = level_rotation(T_world_camera.linear());
  out.level_depth_m = level_depth_m;
  out.ground.raster = std::move(raster);
  if (!out.ground.empty()) out.ground.shape = fit_planes(out.ground.raster, config_.plane_fit);
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, out.R_level_camera);
  decide_by_planes(hazards, T_world_level, out);
  conclude(out);
  return out;
}

void SiteSelector::decide_by_planes(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
                                    SiteSelection& out) const {
  out.ground = judge_ground(std::move(out.ground.raster), std::move(out.ground.shape), hazards,
                            config_.plane_fit, to_radians(config_.max_slope_deg));
  show_ground(T_world_level, out);
  if (out.ground.empty()) return;
  out.status = SiteStatus::kNoFlatArea;
  const cv::Mat radius_m = cv::max(out.ground.radius_m - config_.margin_m, 0.0);
  const double px_per_m = 1 / out.ground.raster.cell_m;
  const auto peaks = separate_peaks(radius_m, config_.ranking.max_sites, config_.min_radius_m,
                                    [&](const cv::Point&) { return px_per_m; });
  if (peaks.empty()) return;
  for (const cv::Point& peak : peaks) out.sites.push_back(site_on(out.ground, peak, T_world_level));
  out.largest = out.sites.front();
}

/// Statuses and the order of the sites.
void SiteSelector::conclude(SiteSelection& out) const {
  if (!out.largest) return;
  out.status = out.largest->radius_m > config_.min_radius_m ? SiteStatus::kFound : SiteStatus::kTooSmall;
  if (!out.found()) {
    out.sites.clear();
    return;
  }
  for (LandingSite& site : out.sites)
    site.score = score(site, config_.ranking, config_.min_radius_m, to_radians(config_.max_slope_deg));
  out.largest = out.sites.front();  // with its score
  std::stable_sort(out.sites.begin(), out.sites.end(),
                   [](const LandingSite& a, const LandingSite& b) { return a.score > b.score; });
}

LandingSite SiteSelector::site_on(const GroundMap& ground, const cv::Point& cell,
                                  const Eigen::Isometry3d& T_world_level) const {
  LandingSite site;
  const Eigen::Vector2d centre_m = ground.raster.centre_m(cell.x, cell.y);
  site.p_world = {centre_m.x(), centre_m.y(), static_cast<double>(ground.raster.mean_m.at<float>(cell))};
  site.p_level = T_world_level.inverse() * site.p_world;
  site.depth_m = site.p_level.z();
  site.centre_px = intrinsics_.project(site.p_level);
  site.radius_m = std::max(0.0, static_cast<double>(ground.radius_m.at<float>(cell)) - config_.margin_m);
  site.radius_px = site.radius_m * focal_px() / site.depth_m;
  site.distance_m = site.p_level.head<2>().norm();
  const double cell_m = ground.raster.cell_m;
  const auto tall_m = static_cast<float>(site.p_world.z() + config_.ranking.obstacle_height_m);
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
  site.obstacle_m = std::min(std::sqrt(obstacle_cells2) * cell_m, config_.plane_fit.reach_m);
  return site;
}

void SiteSelector::decide_by_derivatives(const Eigen::Isometry3d& T_world_level, SiteSelection& out) const {
  out.terrain = measure_terrain(out.level_depth_m, intrinsics_, config_.derivatives);
  out.safe = derivative_safe_mask(out.terrain, out.level_depth_m, intrinsics_, config_.derivatives,
                                  to_radians(config_.max_slope_deg));
  const cv::Mat radius_m = free_radius(out.safe).mul(out.level_depth_m) / focal_px() - config_.margin_m;
  out.radius_m = cv::max(radius_m, 0.0);
  if (cv::countNonZero(out.level_depth_m) == 0) return;
  out.status = SiteStatus::kNoFlatArea;
  double largest_m = 0;
  cv::Point centre;
  cv::minMaxLoc(out.radius_m, nullptr, &largest_m, nullptr, &centre);
  if (largest_m <= 0) return;
  out.largest = circle(out, centre.x, centre.y);
  out.largest->p_world = T_world_level * out.largest->p_level;
  out.sites = {*out.largest};
}

LandingSite SiteSelector::circle(const SiteSelection& selection, int u, int v) const {
  LandingSite site;
  site.centre_px = {u, v};
  site.depth_m = static_cast<double>(selection.level_depth_m.at<float>(v, u));
  site.radius_m = static_cast<double>(selection.radius_m.at<float>(v, u));
  site.radius_px = site.radius_m * focal_px() / site.depth_m;
  site.p_level = intrinsics_.ray(u, v) * site.depth_m;
  site.distance_m = site.p_level.head<2>().norm();
  site.slope_rad = static_cast<double>(selection.terrain.slope_rad.at<float>(v, u));
  return site;
}

std::optional<LandingSite> SiteSelector::circle_at(const SiteSelection& selection,
                                                   const Eigen::Vector2d& centre_px) const {
  if (selection.radius_m.empty() || !centre_px.allFinite() ||
      !intrinsics_.contains(centre_px.x(), centre_px.y())) {
    return std::nullopt;
  }
  const int u = static_cast<int>(std::lround(centre_px.x()));
  const int v = static_cast<int>(std::lround(centre_px.y()));
  if (u < 0 || v < 0 || u >= intrinsics_.width_px || v >= intrinsics_.height_px) return std::nullopt;
  if (selection.radius_m.at<float>(v, u) <= 0) return std::nullopt;
  return circle(selection, u, v);
}

}  // namespace alight
