#include "infer/landing/derivatives/derivative_safety.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"
#include "infer/landing/ground/overhang.hpp"

namespace alight {
namespace {

cv::Mat square(int side_px) { return cv::getStructuringElement(cv::MORPH_RECT, {side_px, side_px}); }

/// Patches that touch the unknown are kept unsafe: nobody knows how they go on.
void forgive_specks(const Terrain& terrain, const cv::Mat& level_depth_m, double focal_px,
                    const DerivativesConfig& config, double max_slope_rad, cv::Mat& safe) {
  struct Patch {
    double area_m2 = 0;
    float excess = 0;
  };
  cv::Mat labels;
  const int count = cv::connectedComponents(~safe, labels, 8, CV_32S);  // the unknown is part of the patches
  std::vector<Patch> patches(static_cast<std::size_t>(count));
  const float slope_limit = static_cast<float>(max_slope_rad);
  const float roughness_limit = static_cast<float>(to_radians(config.max_roughness_deg));
  for (int v = 0; v < safe.rows; ++v) {
    const auto* const label = labels.ptr<int>(v);
    const auto* const depth_m = level_depth_m.ptr<float>(v);
    const auto* const known = terrain.known.ptr<std::uint8_t>(v);
    const auto* const slope_rad = terrain.slope_rad.ptr<float>(v);
    const auto* const roughness_rad = terrain.roughness_rad.ptr<float>(v);
    for (int u = 0; u < safe.cols; ++u) {
      if (label[u] == 0) continue;
      Patch& patch = patches[static_cast<std::size_t>(label[u])];
      const double side_m = static_cast<double>(depth_m[u]) / focal_px;
      patch.area_m2 += known[u] != 0 ? side_m * side_m : std::numeric_limits<double>::infinity();
      patch.excess = std::max({patch.excess, slope_rad[u] / slope_limit, roughness_rad[u] / roughness_limit});
    }
  }
  for (int v = 0; v < safe.rows; ++v) {
    const auto* const label = labels.ptr<int>(v);
    auto* const safe_row = safe.ptr<std::uint8_t>(v);
    for (int u = 0; u < safe.cols; ++u) {
      if (label[u] == 0) continue;  // safe already
      const Patch& patch = patches[static_cast<std::size_t>(label[u])];
      if (patch.area_m2 <= config.speck_max_area_m2 &&
          patch.excess <= static_cast<float>(config.speck_max_excess)) {
        safe_row[u] = 255;
      }
    }
  }
}

}  // namespace

cv::Mat derivative_safe_mask(const Terrain& terrain, const cv::Mat& level_depth_m,
                             const PinholeIntrinsics& intrinsics, const DerivativesConfig& config,
                             double max_slope_rad) {
  cv::Mat safe = (terrain.slope_rad < max_slope_rad) &
                 (terrain.roughness_rad < to_radians(config.max_roughness_deg)) & terrain.known;
  if (config.speck_max_area_m2 > 0) {
    forgive_specks(terrain, level_depth_m, std::max(intrinsics.fx_px, intrinsics.fy_px), config,
                   max_slope_rad, safe);
  }
  if (config.overhang_clearance_m > 0) {
    const cv::Mat obstacles = terrain.known & ~safe;
    safe.setTo(0, ground_beneath(level_depth_m, obstacles, intrinsics, config.overhang_clearance_m));
  }
  if (config.erode_px > 1) cv::erode(safe, safe, square(config.erode_px));
  if (config.dilate_px > 1) cv::dilate(safe, safe, square(config.dilate_px));
  return safe;
}

}  // namespace alight
