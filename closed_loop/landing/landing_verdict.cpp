#include "closed_loop/landing/landing_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "sim/objects/material.hpp"

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

MissionState state_of(const std::string& text) {
  for (const MissionState state : kMissionStates) {
    if (text == name(state)) return state;
  }
  throw DataError("no such state: " + text);
}

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
using Events = std::vector<MissionMachine::Event>;

// What JSON has no type for.
template <class T>
OrderedJson write(const T& value) {
  return value;
}
OrderedJson write(const Outcome& outcome) { return name(outcome); }
OrderedJson write(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
OrderedJson write(const Footprint& f) {
  return {{"slope_deg", f.slope_deg},
          {"residual_m", f.residual_m},
          {"landable_share", f.landable_share},
          {"clearance_m", f.clearance_m}};
}
OrderedJson write(const Events& events) {
  OrderedJson list = OrderedJson::array();
  for (const auto& event : events)
    list.push_back({{"t_ns", event.t_ns}, {"to", name(event.to)}, {"reason", event.reason}});
  return list;
}
template <class T>
OrderedJson write(const std::optional<T>& value) {
  return value ? write(*value) : OrderedJson(nullptr);
}

template <class T>
void read(const Json& json, T& value) {
  json.get_to(value);
}
void read(const Json& json, Outcome& outcome) { outcome = outcome_of(json.get<std::string>()); }
void read(const Json& json, Eigen::Vector3d& p) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    p[axis] = json.at(static_cast<std::size_t>(axis)).get<double>();
}
void read(const Json& json, Footprint& f) {
  f = {json.at("slope_deg").get<double>(), json.at("residual_m").get<double>(),
       json.at("landable_share").get<double>(), json.at("clearance_m").get<double>()};
}
void read(const Json& json, Events& events) {
  for (const Json& row : json) {
    MissionMachine::Event event;
    event.t_ns = row.at("t_ns").get<std::int64_t>();
    event.to = state_of(row.at("to").get<std::string>());
    event.from = events.empty() ? MissionState::kManual : events.back().to;
    event.reason = row.at("reason").get<std::string>();
    events.push_back(std::move(event));
  }
}
template <class T>
void read(const Json& json, std::optional<T>& value) {
  if (!json.is_null()) read(json, value.emplace());
}

/// A key of a row.
struct Field {
  const char* key;
  std::function<OrderedJson(const LandingResult&)> write;
  std::function<void(const Json&, LandingResult&)> read;
};

template <class T>
Field field(const char* key, T LandingResult::* member) {
  return {key, [member](const LandingResult& r) { return write(r.*member); },
          [member](const Json& json, LandingResult& r) { read(json, r.*member); }};
}

/// All keys of a row, in its order.
const std::vector<Field>& fields() {
  using R = LandingResult;
  static const std::vector<Field> kFields = {
      field("seed", &R::seed),
      field("look", &R::look),
      field("fault", &R::fault),
      field("fault_s", &R::fault_s),
      field("fault_lasts_s", &R::fault_lasts_s),
      field("lidar_only", &R::lidar_only),
      field("images", &R::images),
      field("outcome", &R::outcome),
      field("reason", &R::reason),
      field("duration_s", &R::duration_s),
      field("attempts", &R::attempts),
      field("wandered", &R::wandered),
      field("climbed_away", &R::climbed_away),
      field("least_bad", &R::least_bad),
      field("accumulation_s", &R::accumulation_s),
      field("frames", &R::frames),
      field("frames_with_depth", &R::frames_with_depth),
      field("safe_radius_m", &R::safe_radius_m),
      field("p_end", &R::p_end),
      field("miss_m", &R::miss_m),
      field("footprint", &R::footprint),
      field("cost_s", &R::cost_s),
      field("events", &R::events),
  };
  return kFields;
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
  if (r.fault != "none") text += ", " + r.fault + fmt::format(" at {:.1f} s", r.fault_s);
  if (r.fault_lasts_s) text += fmt::format(" for {:.1f} s", *r.fault_lasts_s);
  text += ": ";
  if (r.landed()) {
    const Footprint& f = *r.footprint;
    text += std::string("touched down on ") + (r.outcome == Outcome::kSafe ? "safe" : "UNSAFE") + " ground";
    text += fmt::format(
        " after {:.1f} s (slope {:.1f} deg, roughness {:.2f} m, clearance {:.2f} m, landable {:.0f} %)",
        r.duration_s, f.slope_deg, f.residual_m, f.clearance_m, 100 * f.landable_share);
  } else if (r.outcome == Outcome::kCollided) {
    text += fmt::format("COLLIDED after {:.1f} s: {}", r.duration_s, r.reason);
  } else {
    text += fmt::format("gave up after {:.1f} s: {}", r.duration_s, r.reason);
  }
  const bool site = r.safe_radius_m >= wanted_radius_m;
  return text +
         fmt::format("; {} safe site was within reach (widest {:.1f} m)", site ? "a" : "no", r.safe_radius_m);
}

std::string to_json(const LandingResult& r) {
  nlohmann::ordered_json json;
  for (const Field& field : fields()) json[field.key] = field.write(r);
  return json.dump();
}

LandingResult result_from_json(const std::string& line, const std::string& where) {
  try {
    const auto json = nlohmann::json::parse(line);
    LandingResult r;
    for (const Field& field : fields()) field.read(json.at(field.key), r);
    return r;
  } catch (const nlohmann::json::exception& e) {
    throw DataError(where + ": is no row of a campaign: " + e.what());
  } catch (const DataError& e) {
    throw DataError(where + ": " + e.what());
  }
}

}  // namespace alight::closed_loop
