#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "infer/landing/site_selector.hpp"

namespace alight {

/// What one frame says about a place on the ground that was chosen before.
enum class SiteVerdict {
  kUnseen,  ///< too little of it is in view to say
  kSafe,
  kUnsafe,
};

/// How a place is judged.
struct SiteCheckRule {
  double radius_m = 1.5;           ///< safe ground wanted around it
  double nudge_m = 0;              ///< how far a better centre may be
  double min_known_share = 1.0;    ///< of the circle; 1: the whole circle has to be free ground
  double max_unsafe_share = 0.10;  ///< of its known part; more is unsafe
  double max_height_step_m = 1.0;  ///< ground that has moved more is not the same ground
};

/// The outcome.
struct SiteCheck {
  SiteVerdict verdict = SiteVerdict::kUnseen;
  double radius_m = 0;      ///< of the free circle at p_world
  double known_share = 0;   ///< of the wanted circle
  double unsafe_share = 0;  ///< of its known part
  Eigen::Vector3d p_world =
      Eigen::Vector3d::Zero();  ///< the place, at the ground's height; nudged where that helps
};

/// Judges the place `p_world` by a frame. High up the whole circle has to be free ground (min_known_share = 1); near the
/// ground the LiDAR sees a part of it only, and that part has to be.
/// @param T_world_camera of the frame's camera, whose attitude selection.R_level_camera levels
SiteCheck check_site(const SiteSelector& selector, const SiteSelection& selection,
                     const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& p_world,
                     const SiteCheckRule& rule);

}  // namespace alight
