#include "infer/mission/mission_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, MissionConfig& c) {
  b.field("select_timeout_s", c.select_timeout_s, "without a site for so long: wander", between(0.1, 3600));
  b.field("wander_speed_mps", c.wander_speed_mps, "speed of the search", between(0.1, 30));
  b.field("wander_spacing_m", c.wander_spacing_m, "between the turns of the search spiral",
          between(0.5, 200));
  b.field("geofence_radius_m", c.geofence_radius_m,
          "around where automatic mode begins; no site lies outside", between(1, 10000));
  b.field("choose_height_m", c.choose_height_m,
          "no site is chosen from lower over it, the search goes up instead; 0: off", between(0, 1000));
  b.field("fly_speed_mps", c.fly_speed_mps, "speed on the way to a site", between(0.1, 30));
  b.field("above_tolerance_m", c.above_tolerance_m, "horizontal distance that counts as above the site",
          between(0.05, 10));
  b.field("fly_above_timeout_s", c.fly_above_timeout_s, "then the site is given up", between(1, 3600));
  b.field("descent_speed_mps", c.descent_speed_mps, "down to the height of confirmation", between(0.1, 10));
  b.field("descend_timeout_s", c.descend_timeout_s, "then the vehicle climbs away", between(1, 3600));
  b.field("keep_radius_m", c.keep_radius_m, "safe ground that a chosen site has to keep until confirmed",
          between(0.1, 100));
  b.field("nudge_m", c.nudge_m, "how far a chosen site may move to keep it", between(0, 100));
  b.field("site_timeout_s", c.site_timeout_s, "a site not seen safe for so long is lost", between(0.1, 60));
  b.field("unsafe_frames", c.unsafe_frames, "consecutive frames that make a site unsafe", between(1, 1000));
  b.field("rejected_radius_m", c.rejected_radius_m, "around a site that was given up none is chosen again",
          between(0, 100));
  b.field("confirm_height_m", c.confirm_height_m, "over the site, where dense LiDAR confirms it",
          between(1, 200));
  b.field("confirm_frames", c.confirm_frames, "consecutive frames of dense LiDAR alone", between(1, 1000));
  b.field("confirm_timeout_s", c.confirm_timeout_s, "then the vehicle climbs away", between(0.5, 3600));
  b.field("final_speed_mps", c.final_speed_mps, "of the final descent", between(0.1, 10));
  b.field("touchdown_speed_mps", c.touchdown_speed_mps, "when the ground is near", between(0.05, 5));
  b.field("commit_height_m", c.commit_height_m, "lower only danger that is seen aborts", between(0, 100));
  b.check("commit_height_m", c.commit_height_m < c.confirm_height_m, "must be below confirm_height_m");
  b.field("final_timeout_s", c.final_timeout_s, "then the vehicle climbs away", between(1, 3600));
  b.field("climb_speed_mps", c.climb_speed_mps, "of climbing away", between(0.1, 20));
  b.field("climb_timeout_s", c.climb_timeout_s, "then the search goes on at the height reached",
          between(1, 3600));
  b.field("hold_timeout_s", c.hold_timeout_s, "sensors that stay failed for so long: given up",
          between(0.1, 3600));
  b.field("time_low_s", c.time_low_s, "in automatic mode; then the least bad site will do", between(1, 1e5));
  b.field("time_critical_s", c.time_critical_s, "then the search is given up", between(1, 1e5));
  b.check("time_critical_s", c.time_critical_s >= c.time_low_s, "must not be below time_low_s");
  b.field("battery_low", c.battery_low, "share of the charge; then the least bad site will do",
          between(0, 1));
  b.field("battery_critical", c.battery_critical, "then the search is given up", between(0, 1));
  b.check("battery_critical", c.battery_critical <= c.battery_low, "must not exceed battery_low");
  b.field("least_bad_radius_m", c.least_bad_radius_m, "safe ground that the least bad site has to have",
          between(0.1, 100));
  b.check("least_bad_radius_m", c.least_bad_radius_m <= c.keep_radius_m, "must not exceed keep_radius_m");
  b.field("max_evidence_age_s", c.max_evidence_age_s, "an older result says nothing about now",
          between(0.05, 10));
}

}  // namespace alight
