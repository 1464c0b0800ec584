#include "sim/vehicle/flight_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "sim/counter_random.hpp"

namespace alight::sim {
namespace {

Eigen::Vector3d direction(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad), 0}; }

FlightPhase hover(double duration_s, double blend_s) {
  FlightPhase phase;
  phase.duration_s = duration_s;
  phase.blend_s = std::min(blend_s, duration_s);
  return phase;
}

/// Legs whose headings turn by 60 to 120 degrees to either side, so that the path does not repeat; the
/// vehicle yaws as it likes meanwhile.
void add_search(const FlightPlanConfig& config, std::uint64_t seed, std::vector<FlightPhase>& phases) {
  const CounterRandom random(seed, RandomStream::kFlightPlan);
  double heading_rad = to_radians(config.heading_deg) + random.uniform(0, -0.5, 0.5);
  double left_s = config.search_s;
  for (std::uint64_t leg = 0; left_s > 1e-9; ++leg) {
    FlightPhase phase;
    const bool last = left_s < 1.5 * config.leg_s;
    phase.duration_s = last ? left_s : config.leg_s;
    phase.blend_s = std::min(config.blend_s, phase.duration_s);
    phase.velocity_mps = config.speed_mps * direction(heading_rad);
    phase.yaw_rate_radps = to_radians(config.yaw_rate_deg_per_s) * random.uniform(3 * leg + 1, -1, 1);
    phases.push_back(phase);
    left_s -= phase.duration_s;
    const double side = random.uniform(3 * leg + 2) < 0.5 ? -1.0 : 1.0;
    heading_rad += side * to_radians(random.uniform(3 * leg + 3, 60, 120));
  }
}

/// Stands still, goes by `offset`, stands still: two blends whose halves add up to one `blend_s` at full
/// speed.
void add_move(const Eigen::Vector3d& offset, double speed_mps, double blend_s,
              std::vector<FlightPhase>& phases) {
  const double distance_m = offset.norm();
  if (distance_m < 1e-6) return;
  FlightPhase move;
  move.duration_s = std::max(distance_m / speed_mps, blend_s);
  move.blend_s = blend_s;
  move.velocity_mps = offset / move.duration_s;
  phases.push_back(move);
  phases.push_back(hover(std::max(blend_s, 1e-3), blend_s));
}

/// The safe place nearest to `near` within the limit.
std::optional<Eigen::Vector3d> nearest_site(const FlightPlanConfig& config, const SurfaceTruth& truth,
                                            const Eigen::Vector3d& near) {
  constexpr double kStep_m = 0.5;
  const int steps = static_cast<int>(config.approach_limit_m / kStep_m);
  std::optional<Eigen::Vector3d> best;
  double best_m = config.approach_limit_m;
  for (int iy = -steps; iy <= steps; ++iy) {
    for (int ix = -steps; ix <= steps; ++ix) {
      const Eigen::Vector2d offset(ix * kStep_m, iy * kStep_m);
      const double x_m = near.x() + offset.x();
      const double y_m = near.y() + offset.y();
      if (offset.norm() >= best_m || truth.clearance_m(x_m, y_m) < config.site_radius_m) continue;
      best_m = offset.norm();
      best = Eigen::Vector3d(x_m, y_m, truth.elevation_m(x_m, y_m));
    }
  }
  return best;
}

std::string text(double value) { return fmt::format("{:.1f}", value); }

std::string place(const Eigen::Vector3d& p) { return "(" + text(p.x()) + ", " + text(p.y()) + ")"; }

/// Where the vehicle stands once it has braked after `phases`.
Eigen::Vector3d end_of(const FlightStart& start, const std::vector<FlightPhase>& phases) {
  const FlightPath path(start, phases);
  return path.at(path.duration_s()).p_world;
}

std::vector<FlightPhase> plan_landing(const FlightPlanConfig& config, std::uint64_t seed, double ground_m,
                                      const SurfaceTruth* truth, const FlightStart& start,
                                      const std::string& flight) {
  std::vector<FlightPhase> phases = {hover(std::max(config.hover_s, 1e-3), 0)};
  add_search(config, seed, phases);
  phases.push_back(hover(std::max(config.blend_s, 1e-3), config.blend_s));
  const Eigen::Vector3d searched = end_of(start, phases);
  Eigen::Vector3d site(searched.x(), searched.y(), ground_m);
  if (truth != nullptr) {
    const std::optional<Eigen::Vector3d> found = nearest_site(config, *truth, searched);
    if (!found) {
      throw ConfigError("flight " + flight + ": no safe ground of radius " + text(config.site_radius_m) +
                        " m within " + text(config.approach_limit_m) + " m of " + place(searched) +
                        ", where the search ends; raise plan.approach_limit_m or choose another seed");
    }
    site = *found;
  }
  add_move({site.x() - searched.x(), site.y() - searched.y(), 0}, config.speed_mps, config.blend_s, phases);
  const double drop_m = start.p_world.z() - (site.z() + config.end_height_m);
  if (drop_m < 0) {
    throw ConfigError("flight " + flight + ": the landing place lies " + text(-drop_m) +
                      " m too high for plan.end_height_m; raise plan.start_height_m");
  }
  add_move({0, 0, -drop_m}, config.descent_speed_mps, config.blend_s, phases);
  if (config.end_hover_s > 0) phases.push_back(hover(config.end_hover_s, 0));
  return phases;
}

}  // namespace

void bind(Binder& b, FlightPlanConfig& c) {
  b.choice("kind", c.kind,
           {{"landing", PlanKind::kLanding}, {"hover", PlanKind::kHover}, {"straight", PlanKind::kStraight}},
           "landing: hover, search, approach, descend, hover");
  b.field("start_x_m", c.start_x_m, "take-off place, east of the world's middle");
  b.field("start_y_m", c.start_y_m, "take-off place, north of the world's middle");
  b.field("start_height_m", c.start_height_m, "height above the take-off place at the first moment",
          at_least(1));
  b.field("heading_deg", c.heading_deg, "first heading, counter-clockwise from east");
  b.field("sway_m", c.sway_m, "slow wandering around the path, 1 sigma an axis", between(0, 1));
  b.field("drag_per_s", c.drag_per_s, "deceleration by air drag per unit of velocity", between(0, 2));
  b.field("blend_s", c.blend_s, "time that a change of velocity takes", between(0, 20));
  b.field("duration_s", c.duration_s, "hover and straight: length of the flight", positive());
  b.field("speed_mps", c.speed_mps, "straight, search and approach: horizontal speed", between(0, 30));
  b.field("yaw_rate_deg_per_s", c.yaw_rate_deg_per_s, "straight: yaw rate; search: its limit",
          between(-180, 180));
  b.field("hover_s", c.hover_s, "landing: hover before the search", at_least(0));
  b.field("search_s", c.search_s, "landing: length of the search", at_least(0));
  b.field("leg_s", c.leg_s, "landing: time on one heading of the search", at_least(0.1));
  b.field("site_radius_m", c.site_radius_m, "landing: safe ground wanted around the landing place",
          at_least(0));
  b.field("approach_limit_m", c.approach_limit_m, "landing: how far from the end of the search it may lie",
          at_least(0));
  b.field("descent_speed_mps", c.descent_speed_mps, "landing: speed of the descent", between(0.1, 10));
  b.field("end_height_m", c.end_height_m, "landing: height above the landing place at the end",
          at_least(0.5));
  b.field("end_hover_s", c.end_hover_s, "landing: hover at the end", at_least(0));
  b.check("speed_mps", c.kind != PlanKind::kLanding || c.speed_mps >= 0.1, "a search needs at least 0.1 m/s");
}

FlightPath plan_flight(const FlightPlanConfig& config, std::uint64_t seed, double ground_m,
                       const SurfaceTruth* truth, const std::string& flight) {
  FlightStart start;
  start.p_world = {config.start_x_m, config.start_y_m, ground_m + config.start_height_m};
  start.yaw_rad = to_radians(config.heading_deg);
  std::vector<FlightPhase> phases;
  if (config.kind == PlanKind::kLanding) {
    phases = plan_landing(config, seed, ground_m, truth, start, flight);
  } else {
    FlightPhase phase;
    phase.duration_s = config.duration_s;
    if (config.kind == PlanKind::kStraight) {
      phase.velocity_mps = config.speed_mps * direction(start.yaw_rad);
      phase.yaw_rate_radps = to_radians(config.yaw_rate_deg_per_s);
      start.velocity_mps = phase.velocity_mps;
      start.yaw_rate_radps = phase.yaw_rate_radps;
    }
    phases.push_back(phase);
  }
  FlightPath path(start, phases);
  path.add_sway(config.sway_m, seed);
  return path;
}

void check_path(const FlightPath& path, const SurfaceTruth& truth, double clearance_m, double margin_m,
                const std::string& flight) {
  constexpr double kStep_s = 0.1;
  constexpr double kHalfWidth_m = 1.5;
  const int steps = static_cast<int>(std::ceil(path.duration_s() / kStep_s));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector3d p = path.at(i * kStep_s).p_world;
    const std::string where =
        "flight " + flight + ": at " + text(i * kStep_s) + " s the vehicle is at " + place(p);
    for (const double dx : {-kHalfWidth_m, 0.0, kHalfWidth_m}) {
      for (const double dy : {-kHalfWidth_m, 0.0, kHalfWidth_m}) {
        const double top_m = truth.elevation_m(p.x() + dx, p.y() + dy);
        if (top_m + clearance_m <= p.z()) continue;
        if (std::isnan(top_m))
          throw ConfigError(where + ", outside its world; raise world.size_m or shorten the search");
        throw ConfigError(where + " and only " + text(p.z() - top_m) +
                          " m above an obstacle; raise plan.start_height_m " +
                          "or plan.end_height_m, or choose another seed");
      }
    }
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(margin_m, margin_m), Eigen::Vector2d(-margin_m, -margin_m)}) {
      if (!std::isnan(truth.elevation_m(p.x() + corner.x(), p.y() + corner.y()))) continue;
      throw ConfigError(where +
                        ", too near to the edge of its world; raise world.size_m or shorten the search");
    }
  }
}

}  // namespace alight::sim
