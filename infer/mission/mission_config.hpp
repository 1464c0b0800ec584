#pragma once

#include "foundation/binder_fwd.hpp"

namespace alight {

/// How a landing is flown. Heights are over the ground at the site; the search height is the height at which automatic
/// mode begins, which has to clear everything inside the geofence, or choose_height_m over the ground, if that is higher.
struct MissionConfig {
  // searching
  double select_timeout_s = 5.0;  ///< without a site that counts for so long: wander (the paper)
  double wander_speed_mps = 3.0;
  double wander_spacing_m = 7.0;    ///< between the turns of the search spiral
  double geofence_radius_m = 40.0;  ///< around the place where automatic mode begins; no site lies outside
  /// A site is chosen from no lower than this: from near above a roof fills the view and looks like a street. The LiDAR's
  /// circle has a radius of 0.35 of it, so roofs that are less than 17 m wide are told. 0: off.
  double choose_height_m = 25.0;
  // flying to a site
  double fly_speed_mps = 4.0;
  double above_tolerance_m = 0.5;  ///< horizontally; nearer is above the site
  double fly_above_timeout_s = 40.0;
  double descent_speed_mps = 2.0;
  double descend_timeout_s = 60.0;
  // judging it
  double keep_radius_m =
      1.5;               ///< a chosen site has to keep this much safe ground around it until it is confirmed
  double nudge_m = 2.0;  ///< and may move by so much to keep it
  double site_timeout_s = 1.5;     ///< not seen safe for so long: lost
  int unsafe_frames = 5;           ///< consecutive frames that make a site unsafe
  double rejected_radius_m = 3.0;  ///< around a site that was given up none is chosen again
  // confirming and landing
  double confirm_height_m = 9.0;
  int confirm_frames = 5;  ///< consecutive frames of dense LiDAR alone
  double confirm_timeout_s = 8.0;
  double final_speed_mps = 1.0;
  double touchdown_speed_mps = 0.4;
  double commit_height_m =
      2.5;  ///< lower the LiDAR's circle is too small to judge by; only danger that is seen aborts
  double final_timeout_s = 60.0;
  // leaving
  double climb_speed_mps = 2.5;
  double climb_timeout_s = 30.0;
  /// Failed sensors that do not come back within this time: given up. A sensor that restarts is back in less.
  double hold_timeout_s = 30.0;
  // limits
  double time_low_s = 240.0;  ///< in automatic mode: then the least bad site will do
  double time_critical_s = 300.0;
  double battery_low = 0.30;  ///< share of the charge, as above
  double battery_critical = 0.15;
  double least_bad_radius_m = 1.2;  ///< what the least bad site has to have
  double max_evidence_age_s = 0.8;  ///< an older result says nothing about now
};
void bind(Binder& b, MissionConfig& c);

}  // namespace alight
