#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "geometry/camera.hpp"
#include "infer/landing/ground/site_selection.hpp"

namespace alight {

/// When a site counts, and when to look elsewhere (paper 3.3).
struct SiteTrackerConfig {
  int confirm_frames = 5;          ///< a site counts after so many consecutive frames
  double wander_after_s = 5.0;     ///< no site has counted for so long: wander
  double max_frame_gap_s = 1.0;    ///< frames further apart are not consecutive
  double max_height_step_m = 1.0;  ///< ground that moves more between two frames is not the same ground
};
void bind(Binder& b, SiteTrackerConfig& c);

/// The site being followed.
struct TrackedSite {
  LandingSite circle;  ///< as this frame sees it
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  int frames = 0;         ///< consecutive frames that found it safe, this one included
  bool accepted = false;  ///< the five-frame rule is fulfilled
};

/// What the vehicle may do after a frame.
struct SiteDecision {
  std::optional<TrackedSite> site;  ///< empty: this frame has no site
  bool wander = false;
};

/// Keeps the previous site while the new frame still finds it safe, so that the answer is stable; else takes the
/// frame's largest circle and starts to count anew. Its place in the world stays; only its height follows the depth.
class SiteTracker {
 public:
  /// @param min_radius_m a site that gets smaller is no site any more. @param intrinsics of the level camera
  SiteTracker(const SiteTrackerConfig& config, double min_radius_m, const PinholeIntrinsics& intrinsics);

  /// A frame with trusted depth. Frames must come in time order. @throws std::invalid_argument
  /// @param T_world_camera pose of the left camera (selection.R_level_camera levels it)
  SiteDecision update(std::int64_t t_ns, const SiteSelection& selection,
                      const Eigen::Isometry3d& T_world_camera);

  /// A frame whose depth is not to be trusted: confirms nothing, so counting starts anew; the place is remembered.
  SiteDecision update_without_depth(std::int64_t t_ns);

 private:
  void advance(std::int64_t t_ns);
  std::optional<TrackedSite> keep(const SiteSelection& selection,
                                  const Eigen::Isometry3d& T_world_level) const;
  SiteDecision conclude(std::int64_t t_ns, std::optional<TrackedSite> site);

  SiteTrackerConfig config_;
  double min_radius_m_;
  PinholeIntrinsics intrinsics_;
  std::optional<TrackedSite> site_;
  std::optional<std::int64_t> last_ns_;
  std::int64_t confirmed_ns_ = 0;  // when a site last counted, or the first frame
};

}  // namespace alight
