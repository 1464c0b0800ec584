#pragma once

#include <optional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/derivatives/derivatives_config.hpp"
#include "infer/landing/ground/site_ranking.hpp"
#include "infer/landing/ground/site_selection.hpp"
#include "infer/landing/planes/plane_fit_config.hpp"

namespace alight {

/// How the ground is judged.
enum class LandingMethod {
  kPlaneFit,     ///< planes on discs of the ground, in metres
  kDerivatives,  ///< the paper's: first and second derivative of the depth image
};

/// What counts as safe ground (paper 3.3; the paper's t_inc, t_tur and R).
struct SiteSelectionConfig {
  LandingMethod method = LandingMethod::kPlaneFit;
  double max_slope_deg = 10;
  PlaneFitConfig plane_fit;       ///< kPlaneFit alone
  DerivativesConfig derivatives;  ///< kDerivatives alone
  double min_confidence = 0.5;    ///< pixels with less are unknown, where a confidence is given
  double min_radius_m = 2.0;
  double vehicle_radius_m = 0.85;  ///< from its middle to the tips of its propellers
  /// Taken off every radius: where the vehicle comes down differs by so much from where it wants to.
  double margin_m = 0.0;
  SiteRankingConfig ranking;
};
void bind(Binder& b, SiteSelectionConfig& c);

/// Paper 3.3 steps 2 to 4, free of state. What is unknown and what lies beyond the image is unsafe.
class SiteSelector {
 public:
  SiteSelector(const SiteSelectionConfig& config, const PinholeIntrinsics& intrinsics);

  /// @param depth_m CV_32FC1 plane depth of the left camera, 0 = unknown
  /// @param confidence CV_32FC1 from 0 to 1 of the same size, or empty: the depth is trusted as it is
  /// @throws std::invalid_argument if a size or type is wrong
  SiteSelection select(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                       const cv::Mat& confidence = {}) const;
  /// The same for a camera at the world's origin: positions in the world count from the camera.
  SiteSelection select(const cv::Mat& depth_m, const Eigen::Matrix3d& R_world_camera) const;

  /// select in two steps, for who has something to say in between. First what there is to judge: the level depth and,
  /// with plane_fit, the raster and its planes. Nothing is decided: no map, no site, kNoDepth.
  SiteSelection look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const;
  /// Then the decision.
  /// @param seen of look()
  /// @param hazards see judge_ground; plane_fit only
  SiteSelection decide(SiteSelection seen, const cv::Mat& hazards, const Eigen::Isometry3d& T_world_camera,
                       const cv::Mat& confidence = {}) const;

  /// The decision of plane_fit on a raster that came from elsewhere (fused over frames), seen from a camera.
  /// @param hazards see judge_ground
  /// @param level_depth_m CV_32FC1, what the level camera sees now: where the maps are shown
  SiteSelection judge(ElevationRaster raster, const cv::Mat& hazards, const cv::Mat& level_depth_m,
                      const Eigen::Isometry3d& T_world_camera) const;

  /// The free circle around a pixel of the level camera; empty outside the image and on unsafe ground.
  std::optional<LandingSite> circle_at(const SiteSelection& selection,
                                       const Eigen::Vector2d& centre_px) const;

  /// A raster of this frame's points as plane_fit uses it.
  ElevationRaster raster_of(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const;

  const SiteSelectionConfig& config() const { return config_; }
  const PinholeIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  void decide_by_planes(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
                        SiteSelection& out) const;
  void decide_by_derivatives(const Eigen::Isometry3d& T_world_level, SiteSelection& out) const;
  void show_ground(const Eigen::Isometry3d& T_world_level, SiteSelection& out) const;
  LandingSite site_on(const GroundMap& ground, const cv::Point& cell,
                      const Eigen::Isometry3d& T_world_level) const;
  LandingSite circle(const SiteSelection& selection, int u, int v) const;
  void conclude(SiteSelection& out) const;
  double focal_px() const;

  SiteSelectionConfig config_;
  PinholeIntrinsics intrinsics_;
};

}  // namespace alight
