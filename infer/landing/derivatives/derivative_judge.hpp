#pragma once

#include "geometry/camera.hpp"
#include "infer/landing/derivatives/derivatives_config.hpp"
#include "infer/landing/ground/ground_judge.hpp"
#include "infer/landing/ground/site_rules.hpp"

namespace alight {

/// The paper's way: first and second derivative of the level depth image; the largest circle alone. It makes no raster, so
/// that it takes no hazards.
class DerivativeJudge : public GroundJudge {
 public:
  DerivativeJudge(const DerivativesConfig& config, const SiteRules& rules,
                  const PinholeIntrinsics& intrinsics);

  void look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
            SiteSelection& seen) const override;
  void decide(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
              SiteSelection& out) const override;
  double doubtful_border_m(double metres_per_pixel) const override;

 private:
  DerivativesConfig config_;
  SiteRules rules_;
  PinholeIntrinsics intrinsics_;
};

}  // namespace alight
