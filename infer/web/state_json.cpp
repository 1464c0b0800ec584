#include "infer/web/state_json.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/depth_map.hpp"
#include "infer/replay/overlay.hpp"
#include "infer/replay/result_writer.hpp"

namespace alight {
namespace {

using Json = nlohmann::ordered_json;

/// Four digits are more than a chart shows. What is not finite becomes null.
Json number(double value) { return std::round(value * 1e4) / 1e4; }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

std::string text_of(const FrameReport& report, LandingState state, int confirm_frames) {
  switch (state) {
    case LandingState::kTracking:
      return "tracking " + std::to_string(report.decision.site->frames) + " of " +
             std::to_string(confirm_frames);
    case LandingState::kNoDepth:
      return "no depth";
    case LandingState::kLooking:
    case LandingState::kAccepted:
    case LandingState::kWandering:
      break;
  }
  return name(state);
}

Json landing_json(const FrameReport& report, int confirm_frames) {
  const LandingState state = landing_state(report);
  Json json;
  json["state"] = name(state);
  json["text"] = text_of(report, state, confirm_frames);
  json["reason"] = report.site_reason();
  json["wander"] = report.decision.wander;
  json["depth_m"] = report.decision.site ? number(report.decision.site->circle.depth_m) : Json(nullptr);
  return json;
}

double share_of(const cv::Mat& pixel_source, PixelSource source) {
  if (pixel_source.empty()) return source == PixelSource::kUnknown ? 1 : 0;
  return cv::countNonZero(pixel_source == static_cast<int>(source)) /
         static_cast<double>(pixel_source.total());
}

/// The colours of the depth picture from its nearest to its farthest value.
Json scale_colours() {
  constexpr int kSteps = 16;
  cv::Mat ramp_m(1, kSteps, CV_32FC1);
  for (int i = 0; i < kSteps; ++i) ramp_m.at<float>(0, i) = static_cast<float>(1 + i);
  const cv::Mat colours = colour_depth(ramp_m, 1, kSteps);
  Json json = Json::array();
  for (int i = 0; i < kSteps; ++i) {
    const auto bgr = colours.at<cv::Vec3b>(0, i);
    json.push_back(fmt::format("#{:02x}{:02x}{:02x}", bgr[2], bgr[1], bgr[0]));
  }
  return json;
}

Json depth_json(const DepthResult& depth) {
  Json json;
  const ColourScale scale = depth.depth_m.empty() ? ColourScale{} : colour_scale(depth.depth_m);
  const bool known = scale.max_m > 0;
  json["min_m"] = known ? number(scale.min_m) : Json(nullptr);
  json["max_m"] = known ? number(scale.max_m) : Json(nullptr);
  const double outside = share_of(depth.pixel_source, PixelSource::kPredictedOutsideFov);
  json["predicted_share"] = number(share_of(depth.pixel_source, PixelSource::kPredicted) + outside);
  json["predicted_outside_fov_share"] = number(outside);
  json["interpolated_share"] = number(share_of(depth.pixel_source, PixelSource::kInterpolated));
  json["unknown_share"] = number(share_of(depth.pixel_source, PixelSource::kUnknown));
  json["colours"] = scale_colours();
  return json;
}

Json health_json(const HealthReport& health, std::int64_t t_ns) {
  Json findings = Json::array();
  for (const HealthFinding& finding : health.findings) {
    findings.push_back({{"sensor", finding.sensor},
                        {"fault", finding.fault},
                        {"reason", finding.reason},
                        {"for_s", number(static_cast<double>(t_ns - finding.since_ns) * 1e-9)}});
  }
  return {{"state", name(health.state)}, {"findings", findings}};
}

Json sensors_json(const std::vector<SensorStatus>& sensors) {
  Json json = Json::array();
  for (const SensorStatus& sensor : sensors) {
    json.push_back({{"name", sensor.name},
                    {"count", sensor.count},
                    {"rate_hz", number(sensor.rate_hz)},
                    {"age_s", number(sensor.age_s)}});
  }
  return json;
}

Json engine_json(const RunnerStatistics& statistics) {
  Json dropped = Json::array();
  for (const auto& [reason, count] : statistics.dropped)
    dropped.push_back({{"reason", reason}, {"count", count}});
  return {{"images", statistics.images},
          {"queued", statistics.queued},
          {"last_latency_ms", number(statistics.last_latency_ms)},
          {"max_latency_ms", number(statistics.max_latency_ms)},
          {"dropped", dropped}};
}

/// Rows, since names would be most of the bytes: t_s (since the UNIX epoch), source, accumulation_s, sim, sim_d,
/// sim_pred, holdout_median_m, holdout_rms_m.
Json history_json(const std::vector<HistorySample>& history) {
  Json rows = Json::array();
  for (const HistorySample& sample : history) {
    const bool held_out = sample.holdout.points > 0;
    rows.push_back({number(static_cast<double>(sample.t_ns) * 1e-9), name(sample.source),
                    number(sample.accumulation_s), number(sample.stereo.sim), number(sample.stereo.sim_d),
                    number(sample.stereo.sim_pred),
                    held_out ? number(sample.holdout.median_m) : Json(nullptr),
                    held_out ? number(sample.holdout.rms_m) : Json(nullptr)});
  }
  return rows;
}

/// Reasons may quote bytes from the world; what is not UTF-8 must not take the page down.
std::string write(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

const char* name(LandingState state) {
  switch (state) {
    case LandingState::kLooking:
      break;
    case LandingState::kTracking:
      return "tracking";
    case LandingState::kAccepted:
      return "accepted";
    case LandingState::kWandering:
      return "wandering";
    case LandingState::kNoDepth:
      return "no_depth";
  }
  return "looking";
}

LandingState landing_state(const FrameReport& report) {
  if (report.decision.site)
    return report.decision.site->accepted ? LandingState::kAccepted : LandingState::kTracking;
  if (report.decision.wander) return LandingState::kWandering;
  return report.selection ? LandingState::kLooking : LandingState::kNoDepth;
}

const char* name(FlightMode mode) { return mode == FlightMode::kAutomatic ? "automatic" : "manual"; }

std::string frame_json(const FrameReport& report, const FrameStyle& style) {
  // The line of results.jsonl is text already: parsing it only to print it again would be work for nothing.
  return "{\"result\":" + to_json_line(report, style.crop, true) +
         ",\"landing\":" + write(landing_json(report, style.confirm_frames)) +
         ",\"depth\":" + write(depth_json(report.depth)) +
         ",\"health\":" + write(health_json(report.health, report.depth.t_ns)) + "}";
}

std::string state_json(const LiveState& state) {
  Json json;
  json["run"] = state.run;
  json["mode"] = name(state.mode);
  json["max_rate_hz"] = number(state.max_rate_hz);
  json["sensors"] = sensors_json(state.sensors);
  json["engine"] = engine_json(state.statistics);
  json["history"] = history_json(state.history);
  json["number"] = state.frame ? state.frame->number() : 0;
  json["age_s"] =
      state.frame ? number(milliseconds(state.frame->received(), steady_now()) * 1e-3) : Json(nullptr);
  std::string text = write(json);
  text.pop_back();
  return text + ",\"frame\":" + (state.frame ? state.frame->json() : "null") + "}";
}

}  // namespace alight
