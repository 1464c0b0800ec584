#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "sim/truth/surface_truth.hpp"
#include "sim/vehicle/flight_path.hpp"

namespace alight::sim {

/// landing: hover, search, approach a safe place, descend, hover (paper 3.3). hover: one place. straight: one
/// velocity and one yaw rate.
enum class PlanKind { kLanding, kHover, kStraight };

/// How a vehicle flies. Heights are above the ground of the take-off place, or of the landing place for
/// `end_height_m`.
struct FlightPlanConfig {
  PlanKind kind = PlanKind::kLanding;
  double start_x_m = 0;
  double start_y_m = 0;
  double start_height_m = 40;
  double heading_deg = 90;  ///< counter-clockwise from east
  double sway_m = 0.08;     ///< slow wandering of a real hover
  double drag_per_s = 0.15;
  double blend_s = 1.5;  ///< time that a change of velocity takes

  double duration_s = 10;          ///< hover, straight
  double speed_mps = 3;            ///< straight, search, approach
  double yaw_rate_deg_per_s = 20;  ///< straight; the limit while searching

  double hover_s = 2;  ///< landing: before the search
  double search_s = 12;
  double leg_s = 4;              ///< one heading of the search
  double site_radius_m = 2.5;    ///< safe ground wanted around the landing place
  double approach_limit_m = 15;  ///< how far from the search's end it may lie
  double descent_speed_mps = 3;
  double end_height_m = 4;
  double end_hover_s = 2;
};
void bind(Binder& b, FlightPlanConfig& c);

/// The path of a plan in the simulator's world. Legs, turns and sway are drawn from `seed`.
/// @param ground_m height of the ground at the take-off place
/// @param truth where the ground is safe; null: the descent goes straight down from the end of the search
/// @throws ConfigError if there is no safe place within reach, naming `flight`
FlightPath plan_flight(const FlightPlanConfig& config, std::uint64_t seed, double ground_m,
                       const SurfaceTruth* truth, const std::string& flight);

/// A path must keep off the obstacles and stay over the detailed square of its world.
/// @throws ConfigError naming `flight` and the time, if anything within 1.5 m sideways comes closer than
/// `clearance_m` below, or the square's edge closer than `margin_m`
void check_path(const FlightPath& path, const SurfaceTruth& truth, double clearance_m, double margin_m,
                const std::string& flight);

}  // namespace alight::sim
