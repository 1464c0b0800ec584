#include "closed_loop/landing_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "configs/errors.hpp"
#include "geometry/frames.hpp"
#include "sim/material.hpp"

namespace alight::closed_loop {
namespace {

struct OutcomeName {
  Outcome outcome;
  const char* name;
};
constexpr OutcomeName kOutcomes[] = {{Outcome::kSafe, "safe"},
                                     {Outcome::kUnsafe, "unsafe"},
                                     {Outcome::kCollided, "collided"},
                                     {Outcome::kGaveUp, "gave up"}};

Outcome outcome_of(const std::string& text) {
  for (const OutcomeName& row : kOutcomes) {
    if (text == row.name) return row.outcome;
  }
  throw DataError("no such outcome: " + text);
}

std::string format(const char* pattern, double a) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a);
  return text;
}

}  // namespace

const char* name(Outcome outcome) {
  for (const OutcomeName& row : kOutcomes) {
    if (row.outcome == outcome) return row.name;
  }
  return "";
}

Footprint measure_footprint(const sim::SurfaceTruth& truth, const Eigen::Vector2d& centre, double radius_m) {
  constexpr double kStep_m = 0.1;
  Footprint footprint;
  footprint.clearance_m = truth.clearance_m(centre.x(), centre.y());
  int cells = 0;
  int landable = 0;
  for (double y_m = -radius_m; y_m <= radius_m; y_m += kStep_m) {
    for (double x_m = -radius_m; x_m <= radius_m; x_m += kStep_m) {
      if (std::hypot(x_m, y_m) > radius_m) continue;
      const auto ground = truth.ground_at(centre.x() + x_m, centre.y() + y_m);
      ++cells;
      if (!ground) continue;
      landable += ground->landable ? 1 : 0;
      footprint.slope_deg = std::max(footprint.slope_deg, to_degrees(ground->slope_rad));
      footprint.residual_m = std::max(footprint.residual_m, ground->residual_m);
    }
  }
  footprint.landable_share = cells > 0 ? static_cast<double>(landable) / cells : 0;
  return footprint;
}

double widest_safe_radius_m(const sim::SurfaceTruth& truth, const Eigen::Vector2d& middle, double fence_m) {
  constexpr double kStep_m = 0.2;
  double widest_m = 0;
  for (double y_m = -fence_m; y_m <= fence_m; y_m += kStep_m) {
    for (double x_m = -fence_m; x_m <= fence_m; x_m += kStep_m) {
      if (std::hypot(x_m, y_m) > fence_m) continue;
      widest_m = std::max(widest_m, truth.clearance_m(middle.x() + x_m, middle.y() + y_m));
    }
  }
  return widest_m;
}

std::string describe(const LandingResult& r, double wanted_radius_m) {
  std::string text = r.look + " " + std::to_string(r.seed);
  if (r.fault != "none") text += ", " + r.fault + format(" at %.1f s", r.fault_s);
  text += ": ";
  if (r.landed()) {
    const Footprint& f = *r.footprint;
    text += std::string("touched down on ") + (r.outcome == Outcome::kSafe ? "safe" : "UNSAFE") + " ground";
    text += format(" after %.1f s", r.duration_s) + format(" (slope %.1f deg", f.slope_deg) +
            format(", roughness %.2f m", f.residual_m) + format(", clearance %.2f m", f.clearance_m) +
            format(", landable %.0f %%)", 100 * f.landable_share);
  } else if (r.outcome == Outcome::kCollided) {
    text += "COLLIDED" + format(" after %.1f s: ", r.duration_s) + r.reason;
  } else {
    text += "gave up" + format(" after %.1f s: ", r.duration_s) + r.reason;
  }
  const bool site = r.safe_radius_m >= wanted_radius_m;
  return text + format(site ? "; a safe site was within reach (widest %.1f m)"
                            : "; no safe site was within reach (widest %.1f m)",
                       r.safe_radius_m);
}

std::string to_json(const LandingResult& r) {
  nlohmann::ordered_json json;
  json["seed"] = r.seed;
  json["look"] = r.look;
  json["fault"] = r.fault;
  json["fault_s"] = r.fault_s;
  json["lidar_only"] = r.lidar_only;
  json["images"] = r.images;
  json["outcome"] = name(r.outcome);
  json["reason"] = r.reason;
  json["duration_s"] = r.duration_s;
  json["attempts"] = r.attempts;
  json["wandered"] = r.wandered;
  json["climbed_away"] = r.climbed_away;
  json["least_bad"] = r.least_bad;
  json["accumulation_s"] = r.accumulation_s;
  json["frames"] = r.frames;
  json["frames_with_depth"] = r.frames_with_depth;
  json["safe_radius_m"] = r.safe_radius_m;
  json["p_end"] = {r.p_end.x(), r.p_end.y(), r.p_end.z()};
  json["miss_m"] = r.miss_m;
  json["footprint"] = nullptr;
  if (r.footprint) {
    json["footprint"] = {{"slope_deg", r.footprint->slope_deg},
                         {"residual_m", r.footprint->residual_m},
                         {"landable_share", r.footprint->landable_share},
                         {"clearance_m", r.footprint->clearance_m}};
  }
  json["cost_s"] = r.cost_s;
  json["events"] = nlohmann::ordered_json::array();
  for (const auto& event : r.events) {
    json["events"].push_back({{"t_ns", event.t_ns}, {"to", name(event.to)}, {"reason", event.reason}});
  }
  return json.dump();
}

LandingResult result_from_json(const std::string& line, const std::string& where) {
  try {
    const auto json = nlohmann::json::parse(line);
    LandingResult r;
    r.seed = json.at("seed").get<int>();
    r.look = json.at("look").get<std::string>();
    r.fault = json.at("fault").get<std::string>();
    r.fault_s = json.at("fault_s").get<double>();
    r.lidar_only = json.at("lidar_only").get<bool>();
    r.images = json.at("images").get<bool>();
    r.outcome = outcome_of(json.at("outcome").get<std::string>());
    r.reason = json.at("reason").get<std::string>();
    r.duration_s = json.at("duration_s").get<double>();
    r.attempts = json.at("attempts").get<int>();
    r.wandered = json.at("wandered").get<int>();
    r.climbed_away = json.at("climbed_away").get<int>();
    r.least_bad = json.at("least_bad").get<bool>();
    r.accumulation_s = json.at("accumulation_s").get<double>();
    r.frames = json.at("frames").get<int>();
    r.frames_with_depth = json.at("frames_with_depth").get<int>();
    r.safe_radius_m = json.at("safe_radius_m").get<double>();
    const auto& p = json.at("p_end");
    r.p_end = {p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()};
    r.miss_m = json.at("miss_m").get<double>();
    if (const auto& f = json.at("footprint"); !f.is_null()) {
      r.footprint = Footprint{f.at("slope_deg").get<double>(), f.at("residual_m").get<double>(),
                              f.at("landable_share").get<double>(), f.at("clearance_m").get<double>()};
    }
    r.cost_s = json.at("cost_s").get<double>();
    return r;
  } catch (const nlohmann::json::exception& e) {
    throw DataError(where + ": is no row of a campaign: " + e.what());
  } catch (const DataError& e) {
    throw DataError(where + ": " + e.what());
  }
}

}  // namespace alight::closed_loop
