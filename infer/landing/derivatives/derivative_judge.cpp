#include "infer/landing/derivatives/derivative_judge.hpp"

#include <stdexcept>

#include "geometry/frames.hpp"
#include "infer/landing/derivatives/derivative_safety.hpp"
#include "infer/landing/derivatives/measure_terrain.hpp"
#include "infer/landing/ground/free_radius.hpp"

namespace alight {

DerivativeJudge::DerivativeJudge(const DerivativesConfig& config, const SiteRules& rules,
                                 const PinholeIntrinsics& intrinsics)
    : config_(config), rules_(rules), intrinsics_(intrinsics) {}

void DerivativeJudge::look(const cv::Mat&, const Eigen::Isometry3d&, SiteSelection& seen) const {
  seen.terrain = measure_terrain(seen.level_depth_m, intrinsics_, config_);
}

void DerivativeJudge::decide(const cv::Mat& hazards, const Eigen::Isometry3d& T_world_level,
                             SiteSelection& out) const {
  if (!hazards.empty())
    throw std::invalid_argument(
        "DerivativeJudge: hazards are cells of a raster, which derivatives have not; give none");
  out.safe = derivative_safe_mask(out.terrain, out.level_depth_m, intrinsics_, config_,
                                  to_radians(rules_.max_slope_deg));
  // In metres: over several heights the largest circle in pixels may be another one.
  const cv::Mat radius_m =
      free_radius(out.safe).mul(out.level_depth_m) / radius_focal_px(intrinsics_) - rules_.margin_m;
  out.radius_m = cv::max(radius_m, 0.0);
  if (cv::countNonZero(out.level_depth_m) == 0) return;
  out.status = SiteStatus::kNoFlatArea;
  cv::Point centre;
  cv::minMaxLoc(out.radius_m, nullptr, nullptr, nullptr, &centre);
  out.largest = circle_at(out, intrinsics_, {centre.x, centre.y});
  if (!out.largest) return;
  out.largest->p_world = T_world_level * out.largest->p_level;
  out.sites = {*out.largest};
}

/// Erosion makes so much of the ground beside the unknown unsafe.
double DerivativeJudge::doubtful_border_m(double metres_per_pixel) const {
  return metres_per_pixel * config_.erode_px;
}

}  // namespace alight
