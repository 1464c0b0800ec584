#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "closed_loop/landing/land_config.hpp"
#include "foundation/errors.hpp"
#include "infer/mission/mission_machine.hpp"

namespace alight::closed_loop {

/// How a landing ended.
enum class Outcome {
  kSafe,      ///< touched down on truly safe ground
  kUnsafe,    ///< touched down on ground that is not
  kCollided,  ///< hit something in the air, or the ground other than in a final descent
  kGaveUp,    ///< did not land, and said why
};
/// "safe", "unsafe", "collided", "gave up"
const char* name(Outcome outcome);

/// The ground under a landed vehicle, on the true surface.
struct Footprint {
  double slope_deg = 0;       ///< steepest local plane
  double residual_m = 0;      ///< largest distance to a local plane
  double landable_share = 0;  ///< no water, plant, roof or car
  double clearance_m = 0;     ///< safe ground around the middle
};
Footprint measure_footprint(const sim::SurfaceTruth& truth, const Eigen::Vector2d& centre, double radius_m);

/// The widest truly safe circle inside the geofence.
double widest_safe_radius_m(const sim::SurfaceTruth& truth, const Eigen::Vector2d& middle, double fence_m);

/// Everything about a finished landing that a row of a campaign keeps. Positions in the simulator's world.
struct LandingResult {
  int seed = 0;
  std::string look;
  std::string fault = "none";
  double fault_s = 0;                   ///< when it struck; 0 without fault
  std::optional<double> fault_lasts_s;  ///< none: to the end
  bool lidar_only = true;
  bool images = true;
  Outcome outcome = Outcome::kGaveUp;
  std::string reason;     ///< of the last transition, or what was hit
  double duration_s = 0;  ///< from the begin of automatic mode
  int attempts = 0;       ///< sites flown to
  int wandered = 0;       ///< times that the search went elsewhere
  int climbed_away = 0;
  bool least_bad = false;     ///< the last site was taken for want of energy
  double accumulation_s = 0;  ///< mean over the frames with depth
  int frames = 0;
  int frames_with_depth = 0;
  double safe_radius_m = 0;  ///< widest truly safe circle inside the geofence
  Eigen::Vector3d p_end = Eigen::Vector3d::Zero();
  double miss_m = 0;  ///< from the chosen site to the touchdown, both as the vehicle saw them
  std::optional<Footprint> footprint;
  double cost_s = 0;  ///< of this computer's processor time, the making of the world in it
  std::vector<MissionMachine::Event> events;

  /// "LiDAR lost", "LiDAR lost for a while"
  std::string fault_kind() const { return fault + (fault_lasts_s ? " for a while" : ""); }
  bool landed() const { return outcome == Outcome::kSafe || outcome == Outcome::kUnsafe; }
};

/// "village 1003: touched down on safe ground after 38.2 s; ..."
std::string describe(const LandingResult& result, double wanted_radius_m);

/// One line of JSON, and back. @throws DataError naming `where`
std::string to_json(const LandingResult& result);
LandingResult result_from_json(const std::string& line, const std::string& where);

}  // namespace alight::closed_loop
