#include "infer/landing/memory/site_tracker.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "geometry/reprojection.hpp"

namespace alight {

void bind(Binder& b, SiteTrackerConfig& c) {
  b.field("confirm_frames", c.confirm_frames, "consecutive frames after which a site counts",
          between(1, 1000));
  b.field("wander_after_s", c.wander_after_s, "time without a site that counts, then wander",
          between(0.1, 3600));
  b.field("max_frame_gap_s", c.max_frame_gap_s, "frames further apart are not consecutive",
          between(0.01, 60));
  b.field("max_height_step_m", c.max_height_step_m,
          "a site whose height changes more between frames is dropped", between(0.01, 100));
}

SiteTracker::SiteTracker(const SiteTrackerConfig& config, double min_radius_m,
                         const PinholeIntrinsics& intrinsics)
    : config_(config), min_radius_m_(min_radius_m), intrinsics_(intrinsics) {}

void SiteTracker::advance(std::int64_t t_ns) {
  if (!last_ns_) confirmed_ns_ = t_ns;
  if (last_ns_ && t_ns <= *last_ns_)
    throw std::invalid_argument("SiteTracker: frames must come in time order");
  if (last_ns_ && to_seconds(t_ns - *last_ns_) > config_.max_frame_gap_s && site_) site_->frames = 0;
  last_ns_ = t_ns;
}

std::optional<TrackedSite> SiteTracker::keep(const SiteSelection& selection,
                                             const Eigen::Isometry3d& T_world_level) const {
  if (!site_) return std::nullopt;
  const Eigen::Vector3d p_level = T_world_level.inverse() * site_->p_world;
  if (p_level.z() <= 0) return std::nullopt;
  const auto circle = circle_at(selection, intrinsics_, intrinsics_.project(p_level));
  if (!circle || circle->radius_m <= min_radius_m_) return std::nullopt;
  if (std::abs(circle->depth_m - p_level.z()) > config_.max_height_step_m) return std::nullopt;
  TrackedSite kept = *site_;
  kept.circle = *circle;
  kept.p_world.z() -= circle->depth_m - p_level.z();  // the level camera's axis is world down
  ++kept.frames;
  return kept;
}

SiteDecision SiteTracker::conclude(std::int64_t t_ns, std::optional<TrackedSite> site) {
  if (site) site->accepted = site->frames >= config_.confirm_frames;
  if (site && site->accepted) confirmed_ns_ = t_ns;
  SiteDecision decision;
  decision.wander = to_seconds(t_ns - confirmed_ns_) > config_.wander_after_s;
  decision.site = std::move(site);
  return decision;
}

SiteDecision SiteTracker::update(std::int64_t t_ns, const SiteSelection& selection,
                                 const Eigen::Isometry3d& T_world_camera) {
  advance(t_ns);
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, selection.R_level_camera);
  std::optional<TrackedSite> now = keep(selection, T_world_level);
  if (!now && selection.found()) {
    // The best one in view: only there can it be confirmed.
    for (const LandingSite& site : selection.sites) {
      const Eigen::Vector2d& px = site.centre_px;
      if (site.p_level.z() <= 0 || !intrinsics_.contains(px.x(), px.y())) continue;
      now = TrackedSite{site, T_world_level * site.p_level, 1, false};
      break;
    }
  }
  site_ = now;
  return conclude(t_ns, std::move(now));
}

SiteDecision SiteTracker::update_without_depth(std::int64_t t_ns) {
  advance(t_ns);
  if (site_) site_->frames = 0;
  return conclude(t_ns, std::nullopt);
}

}  // namespace alight
