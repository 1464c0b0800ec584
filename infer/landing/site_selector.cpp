#include "infer/landing/site_selector.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/derivatives/derivative_judge.hpp"
#include "infer/landing/planes/plane_judge.hpp"

namespace alight {
namespace {

std::shared_ptr<const GroundJudge> judge_of(const SiteSelectionConfig& config,
                                            const PinholeIntrinsics& intrinsics) {
  if (config.method == LandingMethod::kDerivatives)
    return std::make_shared<DerivativeJudge>(config.derivatives, config.rules, intrinsics);
  return std::make_shared<PlaneJudge>(config.plane_fit, config.rules, intrinsics);
}

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
  bind(b, c.rules);
}

SiteSelector::SiteSelector(const SiteSelectionConfig& config, const PinholeIntrinsics& intrinsics)
    : config_(config), intrinsics_(intrinsics), judge_(judge_of(config, intrinsics)) {}

SiteSelection SiteSelector::select(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                                   const cv::Mat& confidence) const {
  cv::Mat trusted_m = depth_m;
  if (!confidence.empty()) {
    if (confidence.type() != CV_32FC1 || confidence.size() != depth_m.size())
      throw std::invalid_argument("SiteSelector: confidence must be CV_32FC1 of the depth's size");
    trusted_m = depth_m.clone();
    trusted_m.setTo(0, confidence < config_.rules.min_confidence);
  }
  return decide(look(trusted_m, T_world_camera), {}, T_world_camera, confidence);
}

SiteSelection SiteSelector::select(const cv::Mat& depth_m, const Eigen::Matrix3d& R_world_camera) const {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = R_world_camera;
  return select(depth_m, T_world_camera);
}

SiteSelection SiteSelector::look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera) const {
  SiteSelection seen;
  // 2) What a camera with roll and pitch zero sees.
  seen.R_level_camera = level_rotation(T_world_camera.linear());
  seen.level_depth_m = rotate_depth(depth_m, intrinsics_, seen.R_level_camera);
  judge_->look(depth_m, T_world_camera, seen);
  return seen;
}

SiteSelection SiteSelector::decide(SiteSelection seen, const cv::Mat& hazards,
                                   const Eigen::Isometry3d& T_world_camera, const cv::Mat& confidence) const {
  SiteSelection out = std::move(seen);
  // 3) Safe ground. 4) Circles on it.
  judge_->decide(hazards, level_pose(T_world_camera, out.R_level_camera), out);
  if (!confidence.empty()) {
    for (LandingSite& site : out.sites)
      site.confidence = confidence_on(site, confidence, out.R_level_camera, intrinsics_);
  }
  conclude(config_.rules, out);
  return out;
}

}  // namespace alight
