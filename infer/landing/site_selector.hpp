#pragma once

#include <memory>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"
#include "infer/landing/derivatives/derivatives_config.hpp"
#include "infer/landing/ground/ground_judge.hpp"
#include "infer/landing/ground/site_rules.hpp"
#include "infer/landing/ground/site_selection.hpp"
#include "infer/landing/planes/plane_fit_config.hpp"

namespace alight {

/// How the ground is judged.
enum class LandingMethod {
  kPlaneFit,     ///< planes on discs of the ground, in metres
  kDerivatives,  ///< the paper's: first and second derivative of the depth image
};

/// What counts as safe ground. The sections of the methods hold what concerns the one alone; the rules are keys beside them.
struct SiteSelectionConfig {
  LandingMethod method = LandingMethod::kPlaneFit;
  PlaneFitConfig plane_fit;
  DerivativesConfig derivatives;
  SiteRules rules;
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

  /// select in two steps, for who has something to say in between. First what there is to judge: the level depth and what
  /// the method goes by (GroundJudge::look). Nothing is decided: no site, kNoDepth.
  SiteSelection look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const;
  /// Then the decision.
  /// @param seen of look()
  /// @param hazards CV_8UC1 of the size of seen.ground.raster, non-zero = unsafe; empty: none
  /// @throws std::invalid_argument if there are hazards and no raster of their size
  SiteSelection decide(SiteSelection seen, const cv::Mat& hazards, const Eigen::Isometry3d& T_world_camera,
                       const cv::Mat& confidence = {}) const;

  const SiteSelectionConfig& config() const { return config_; }
  const PinholeIntrinsics& intrinsics() const { return intrinsics_; }
  const GroundJudge& judge() const { return *judge_; }

 private:
  SiteSelectionConfig config_;
  PinholeIntrinsics intrinsics_;
  std::shared_ptr<const GroundJudge> judge_;  // never changes, so that copies share it
};

}  // namespace alight
