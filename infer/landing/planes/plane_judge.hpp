#pragma once

#include "geometry/camera.hpp"
#include "infer/landing/ground/ground_judge.hpp"
#include "infer/landing/ground/site_rules.hpp"
#include "infer/landing/planes/plane_fit_config.hpp"

namespace alight {

/// Planes on discs of the ground, in metres; up to ranking.max_sites separate circles.
class PlaneJudge : public GroundJudge {
 public:
  PlaneJudge(const PlaneFitConfig& config, const SiteRules& rules, const PinholeIntrinsics& intrinsics);

  void look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
            SiteSelection& seen) const override;
  /// The same for a raster that came from elsewhere (fused over frames).
  void look(ElevationRaster raster, SiteSelection& seen) const;
  void decide(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
              SiteSelection& out) const override;
  /// Planes need a whole known disc and no guard towards the unknown, so that the cells of the border are enough.
  double doubtful_border_m(double) const override { return config_.cell_m; }

  const PlaneFitConfig& config() const { return config_; }
  const SiteRules& rules() const { return rules_; }
  const PinholeIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  ElevationRaster raster_of(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const;
  LandingSite site_on(const GroundMap& ground, const cv::Point& cell,
                      const Eigen::Isometry3d& T_world_level) const;

  PlaneFitConfig config_;
  SiteRules rules_;
  PinholeIntrinsics intrinsics_;
};

}  // namespace alight
