#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "infer/landing/terrain.hpp"

namespace alight {

/// What counts as safe ground (paper 3.3; the paper's t_inc, t_tur and R).
struct SiteSelectionConfig {
  TerrainConfig terrain;
  double max_slope_deg = 10;
  double max_roughness_deg = 10;
  /// Point and pose noise make specks that just exceed a limit, and one speck is enough to cut a circle in half. An
  /// unsafe patch is taken for noise when it is smaller than this *and* nowhere exceeds a limit by more than
  /// speck_max_excess: a pole, a stone or a wire is far over the limit where it stands, a kerb is long. 0: off.
  double speck_max_area_m2 = 0.15;
  double speck_max_excess = 1.5;  ///< as a multiple of the limit
  /// Sides of the squares by which the safe mask is eroded, then dilated. Equal: specks and threads of safe ground
  /// vanish and no pixel becomes safe. A larger erosion keeps a distance to everything unsafe.
  int erode_px = 3;
  int dilate_px = 3;
  /// Ground below an obstacle that hangs higher than this over it is unsafe too. 0: off, the paper.
  double overhang_clearance_m = 0.5;
  double min_radius_m = 2.0;
  /// Taken off every radius: what the vehicle needs on top for control error.
  double margin_m = 0.0;
};
void bind(Binder& b, SiteSelectionConfig& c);

/// A circle of safe ground, seen by the level camera.
struct LandingSite {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< in the level camera's image
  double radius_px = 0;
  double depth_m = 0;                                 ///< plane depth of the centre
  double radius_m = 0;                                ///< depth / f * radius_px
  Eigen::Vector3d p_level = Eigen::Vector3d::Zero();  ///< the centre in the level camera's frame
};

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
  Eigen::Matrix3d R_level_camera = Eigen::Matrix3d::Identity();
  cv::Mat level_depth_m;  ///< CV_32FC1
  Terrain terrain;
  cv::Mat safe;      ///< CV_8UC1, 255 = safe
  cv::Mat radius_m;  ///< CV_32FC1, radius of the free circle around every pixel, 0 where unsafe

  bool found() const { return status == SiteStatus::kFound; }
};

/// "landing site of 3.1 m", "no depth", "no flat area", "largest circle 1.4 m".
std::string describe(const SiteSelection& selection);

/// Paper 3.3 steps 2 to 4, free of state. What is unknown and what lies beyond the image is unsafe.
class SiteSelector {
 public:
  SiteSelector(const SiteSelectionConfig& config, const PinholeIntrinsics& intrinsics);

  /// @param depth_m CV_32FC1 plane depth of the left camera, 0 = unknown
  /// @param R_world_camera the camera's attitude; only roll and pitch matter
  SiteSelection select(const cv::Mat& depth_m, const Eigen::Matrix3d& R_world_camera) const;

  /// The free circle around a pixel of the level camera; empty outside the image and on unsafe ground.
  std::optional<LandingSite> circle_at(const SiteSelection& selection,
                                       const Eigen::Vector2d& centre_px) const;

  const SiteSelectionConfig& config() const { return config_; }
  const PinholeIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  cv::Mat safe_mask(const Terrain& terrain, const cv::Mat& level_depth_m) const;
  void forgive_specks(const Terrain& terrain, const cv::Mat& level_depth_m, cv::Mat& safe) const;
  cv::Mat free_radius_m(const cv::Mat& safe, const cv::Mat& level_depth_m) const;
  LandingSite circle(const SiteSelection& selection, int u, int v) const;
  double focal_px() const;

  SiteSelectionConfig config_;
  PinholeIntrinsics intrinsics_;
};

}  // namespace alight
