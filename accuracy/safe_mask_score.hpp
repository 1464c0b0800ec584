#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "sim/render/renderer.hpp"
#include "sim/truth/surface_truth.hpp"

namespace alight::bench {

/// What an ideal LiDAR with a beam in every pixel measures.
struct PerfectDepth {
  cv::Mat depth_m;   ///< CV_32FC1 plane depth, exact; 0 where nothing comes back (water, sky)
  cv::Mat material;  ///< CV_8UC1 of sim::Material, of what every pixel shows
};
PerfectDepth perfect_depth(const sim::Renderer& renderer, const PinholeIntrinsics& intrinsics,
                           const Eigen::Isometry3d& T_world_camera);

/// The material map seen by the level camera, nearest pixel; 255 where the camera itself saw nothing: beyond its image.
cv::Mat level_material(const cv::Mat& material, const PinholeIntrinsics& intrinsics,
                       const Eigen::Matrix3d& R_level_camera);

/// What the truth says of a level view.
struct TruthView {
  cv::Mat safe;     ///< CV_8UC1, the ground under the pixel is safe
  cv::Mat roomy;    ///< CV_8UC1, and so is everything within `clearance_m` of it, all of it inside the view
  cv::Mat area_m2;  ///< CV_32FC1, ground that a pixel shows; 0 where nothing is known
  cv::Mat
      hidden;  ///< CV_8UC1, something that decides the truth here is outside the image: a crown over this ground
  cv::Mat at_limit;  ///< CV_8UC1, slope within 0.5 degrees or residual within 1 cm of the truth's limit
};
/// @param material from level_material
TruthView truth_view(const sim::SurfaceTruth& truth, const sim::SurfaceTruthConfig& config,
                     const cv::Mat& level_depth_m, const cv::Mat& material,
                     const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_level,
                     double clearance_m);

/// Areas in square metres, added up over frames.
struct MaskScore {
  double called_safe_m2 = 0;
  double rightly_m2 = 0;           ///< of these truly safe
  double wrongly_hidden_m2 = 0;    ///< of the others, decided by what is outside the image
  double wrongly_at_limit_m2 = 0;  ///< of the rest, at the truth's limit
  double roomy_m2 = 0;             ///< truly safe with the vehicle's clearance
  double found_m2 = 0;             ///< of these called safe
  std::map<std::string, double> wrong_by_material_m2;

  void add(const MaskScore& other);
  double precision() const { return called_safe_m2 > 0 ? rightly_m2 / called_safe_m2 : 1; }
  /// The same without what the image cannot show.
  double precision_of_seen() const { return without(wrongly_hidden_m2); }
  /// And without what lies at the truth's limit.
  double precision_off_limit() const { return without(wrongly_hidden_m2 + wrongly_at_limit_m2); }
  double recall() const { return roomy_m2 > 0 ? found_m2 / roomy_m2 : 1; }

 private:
  double without(double area_m2) const {
    return called_safe_m2 > area_m2 ? rightly_m2 / (called_safe_m2 - area_m2) : 1;
  }
};
MaskScore score_mask(const cv::Mat& safe, const TruthView& truth, const cv::Mat& material);

/// A camera over a world, roll and pitch drawn up to `max_tilt_deg`.
struct Station {
  double height_m = 0;  ///< over the bare ground
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};
/// Up to `count` cameras with free air of `air_m` below and around; the same seed draws the same ones.
std::vector<Station> stations(const sim::World& world, const sim::SurfaceTruth& truth, double height_m,
                              int count, double max_tilt_deg, std::uint64_t seed);

}  // namespace alight::bench
