#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/ground/ground_map.hpp"
#include "infer/landing/ground/landing_site.hpp"
#include "infer/landing/ground/site_rules.hpp"
#include "infer/landing/ground/terrain.hpp"

namespace alight {

/// What came of the search for a site.
enum class SiteStatus {
  kFound,
  kNoDepth,     ///< no pixel has a depth
  kNoFlatArea,  ///< depth, but no safe pixel
  kTooSmall,    ///< the largest circle is smaller than min_radius_m
};

/// The outcome for one depth map, with the maps that it was drawn from. Frame: the level camera.
struct SiteSelection {
  SiteStatus status = SiteStatus::kNoDepth;
  /// The largest circle, whatever its size; absent where there is no safe pixel. Only kFound makes it a site.
  std::optional<LandingSite> largest;
  /// Separate circles larger than min_radius_m, the best score first; with plane_fit up to ranking.max_sites of them,
  /// with the derivatives the largest alone.
  std::vector<LandingSite> sites;
  Eigen::Matrix3d R_level_camera = Eigen::Matrix3d::Identity();
  cv::Mat level_depth_m;  ///< CV_32FC1
  Terrain terrain;
  cv::Mat safe;      ///< CV_8UC1, 255 = safe
  cv::Mat radius_m;  ///< CV_32FC1, radius of the free circle around every pixel, 0 where unsafe
  GroundMap ground;  ///< plane_fit: the judged raster that the maps above show; else empty

  bool found() const { return status == SiteStatus::kFound; }
};

/// The free circle around a pixel of the level camera; empty outside the image and on unsafe ground.
/// @param intrinsics of the level camera, whose size the maps have
std::optional<LandingSite> circle_at(const SiteSelection& selection, const PinholeIntrinsics& intrinsics,
                                     const Eigen::Vector2d& centre_px);

/// The end of a selection, once its circles are found: status, scores and the order of the sites.
void conclude(const SiteRules& rules, SiteSelection& selection);

/// "landing site of 3.1 m", "no depth", "no flat area", "largest circle 1.4 m".
std::string describe(const SiteSelection& selection);

}  // namespace alight
