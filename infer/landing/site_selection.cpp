#include "infer/landing/site_selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/overhang.hpp"

namespace alight {
namespace {

cv::Mat square(int side_px) { return cv::getStructuringElement(cv::MORPH_RECT, {side_px, side_px}); }

/// Distance of every safe pixel's centre to the edge of the nearest unsafe pixel; beyond the image all is unsafe.
cv::Mat free_radius_px(const cv::Mat& safe) {
  cv::Mat framed;
  cv::copyMakeBorder(safe, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat distance;
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat radius = distance(cv::Rect({1, 1}, safe.size())) - 0.5;
  return cv::max(radius, 0.0);
}

}  // namespace

void bind(Binder& b, SiteSelectionConfig& c) {
  b.section("terrain", c.terrain, "how the shape of the ground is measured");
  b.field("max_slope_deg", c.max_slope_deg, "steepest safe ground", between(0.1, 60));
  b.field("max_roughness_deg", c.max_roughness_deg, "largest safe change of slope", between(0.1, 60));
  b.field("speck_max_area_m2", c.speck_max_area_m2, "a smaller unsafe patch may be noise; 0: none is",
          between(0, 10));
  b.field("speck_max_excess", c.speck_max_excess, "if it nowhere exceeds this multiple of a limit",
          between(1, 10));
  b.field("erode_px", c.erode_px, "side of the square that erodes the safe mask; 1: none", between(1, 99));
  b.field("dilate_px", c.dilate_px, "side of the square that dilates it again; 1: none", between(1, 99));
  b.check("dilate_px", c.dilate_px <= c.erode_px,
          "must not exceed erode_px: it would make unsafe ground safe");
  b.field("overhang_clearance_m", c.overhang_clearance_m,
          "ground below obstacles that hang higher over it is unsafe; 0: off", between(0, 100));
  b.field("min_radius_m", c.min_radius_m, "a site has to be larger than this", between(0.1, 100));
  b.field("margin_m", c.margin_m, "taken off every radius", between(0, 100));
}

std::string describe(const SiteSelection& selection) {
  if (selection.status == SiteStatus::kNoDepth) return "no depth";
  if (!selection.largest) return "no flat area";
  char text[64];
  std::snprintf(text, sizeof text, selection.found() ? "landing site of %.1f m" : "largest circle %.1f m",
                selection.largest->radius_m);
  return text;
}

SiteSelector::SiteSelector(const SiteSelectionConfig& config, const PinholeIntrinsics& intrinsics)
    : config_(config), intrinsics_(intrinsics) {}

/// The longer one makes the smaller circle.
double SiteSelector::focal_px() const { return std::max(intrinsics_.fx_px, intrinsics_.fy_px); }

/// Patches that touch the unknown are kept unsafe: nobody knows how they go on.
void SiteSelector::forgive_specks(const Terrain& terrain, const cv::Mat& level_depth_m, cv::Mat& safe) const {
  struct Patch {
    double area_m2 = 0;
    float excess = 0;
  };
  cv::Mat labels;
  const int count = cv::connectedComponents(~safe, labels, 8, CV_32S);  // the unknown is part of the patches
  std::vector<Patch> patches(static_cast<std::size_t>(count));
  const float slope_limit = static_cast<float>(to_radians(config_.max_slope_deg));
  const float roughness_limit = static_cast<float>(to_radians(config_.max_roughness_deg));
  for (int v = 0; v < safe.rows; ++v) {
    for (int u = 0; u < safe.cols; ++u) {
      const int label = labels.at<int>(v, u);
      if (label == 0) continue;
      Patch& patch = patches[static_cast<std::size_t>(label)];
      const double side_m = static_cast<double>(level_depth_m.at<float>(v, u)) / focal_px();
      const bool known = terrain.known.at<std::uint8_t>(v, u) != 0;
      patch.area_m2 += known ? side_m * side_m : std::numeric_limits<double>::infinity();
      patch.excess = std::max({patch.excess, terrain.slope_rad.at<float>(v, u) / slope_limit,
                               terrain.roughness_rad.at<float>(v, u) / roughness_limit});
    }
  }
  for (int v = 0; v < safe.rows; ++v) {
    for (int u = 0; u < safe.cols; ++u) {
      const Patch& patch = patches[static_cast<std::size_t>(labels.at<int>(v, u))];
      if (patch.area_m2 <= config_.speck_max_area_m2 &&
          patch.excess <= static_cast<float>(config_.speck_max_excess)) {
        safe.at<std::uint8_t>(v, u) = 255;
      }
    }
  }
}

cv::Mat SiteSelector::safe_mask(const Terrain& terrain, const cv::Mat& level_depth_m) const {
  cv::Mat safe = (terrain.slope_rad < to_radians(config_.max_slope_deg)) &
                 (terrain.roughness_rad < to_radians(config_.max_roughness_deg)) & terrain.known;
  if (config_.speck_max_area_m2 > 0) forgive_specks(terrain, level_depth_m, safe);
  if (config_.overhang_clearance_m > 0) {
    const cv::Mat obstacles = terrain.known & ~safe;
    safe.setTo(0, ground_beneath(level_depth_m, obstacles, intrinsics_, config_.overhang_clearance_m));
  }
  if (config_.erode_px > 1) cv::erode(safe, safe, square(config_.erode_px));
  if (config_.dilate_px > 1) cv::dilate(safe, safe, square(config_.dilate_px));
  return safe;
}

cv::Mat SiteSelector::free_radius_m(const cv::Mat& safe, const cv::Mat& level_depth_m) const {
  cv::Mat radius_m = free_radius_px(safe).mul(level_depth_m) / focal_px() - config_.margin_m;
  return cv::max(radius_m, 0.0);
}

LandingSite SiteSelector::circle(const SiteSelection& selection, int u, int v) const {
  LandingSite site;
  site.centre_px = {u, v};
  site.depth_m = static_cast<double>(selection.level_depth_m.at<float>(v, u));
  site.radius_m = static_cast<double>(selection.radius_m.at<float>(v, u));
  site.radius_px = site.radius_m * focal_px() / site.depth_m;
  site.p_level = intrinsics_.ray(u, v) * site.depth_m;
  return site;
}

SiteSelection SiteSelector::select(const cv::Mat& depth_m, const Eigen::Matrix3d& R_world_camera) const {
  SiteSelection out;
  // 2) What a camera with roll and pitch zero sees.
  out.R_level_camera = level_rotation(R_world_camera);
  out.level_depth_m = rotate_depth(depth_m, intrinsics_, out.R_level_camera);
  // 3) First and second derivatives of the height, as angles.
  out.terrain = measure_terrain(out.level_depth_m, intrinsics_, config_.terrain);
  out.safe = safe_mask(out.terrain, out.level_depth_m);
  // 4) The largest inscribed circle, in metres: over several heights the largest in pixels may be another one.
  out.radius_m = free_radius_m(out.safe, out.level_depth_m);
  if (cv::countNonZero(out.level_depth_m) == 0) return out;
  double radius_m = 0;
  cv::Point centre;
  cv::minMaxLoc(out.radius_m, nullptr, &radius_m, nullptr, &centre);
  out.status = radius_m <= 0                     ? SiteStatus::kNoFlatArea
               : radius_m > config_.min_radius_m ? SiteStatus::kFound
                                                 : SiteStatus::kTooSmall;
  if (radius_m > 0) out.largest = circle(out, centre.x, centre.y);
  return out;
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
