#include "infer/replay/result_writer.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "foundation/errors.hpp"
#include "foundation/order_statistics.hpp"

namespace alight {
namespace {

using Json = nlohmann::ordered_json;

/// Six digits are finer than any of it is known, and the same on every machine.
Json number(double value) { return std::round(value * 1e6) / 1e6; }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json holdout_json(const HoldoutScores& holdout, double value) {
  return holdout.points > 0 ? number(value) : Json(nullptr);
}

/// The circles that a decision found, the best first.
Json sites_json(const SiteSelection& selection) {
  Json sites = Json::array();
  for (const LandingSite& site : selection.sites) {
    Json json;
    json["p_world"] = {number(site.p_world.x()), number(site.p_world.y()), number(site.p_world.z())};
    json["radius_m"] = number(site.radius_m);
    json["score"] = number(site.score);
    sites.push_back(json);
  }
  return sites;
}

Json site_json(const FrameReport& frame) {
  if (!frame.decision.site || !frame.image_site) return nullptr;
  const TrackedSite& site = *frame.decision.site;
  Json json;
  json["u_px"] = number(frame.image_site->u_px);
  json["v_px"] = number(frame.image_site->v_px);
  json["radius_px"] = number(frame.image_site->radius_px);
  json["radius_m"] = number(site.circle.radius_m);
  json["p_world"] = {number(site.p_world.x()), number(site.p_world.y()), number(site.p_world.z())};
  json["frames"] = site.frames;
  json["accepted"] = site.accepted;
  return json;
}

Json to_json(const HealthReport& health) {
  Json json;
  json["state"] = name(health.state);
  json["findings"] = Json::array();
  for (const HealthFinding& finding : health.findings) {
    json["findings"].push_back({{"sensor", finding.sensor},
                                {"fault", finding.fault},
                                {"reason", finding.reason},
                                {"since_ns", finding.since_ns}});
  }
  return json;
}

double percentile(std::vector<double> values, double share) {
  const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  return value_at_place(values, index);
}

}  // namespace

std::string to_json_line(const FrameReport& frame, const cv::Rect& crop, bool with_timings) {
  const DepthResult& depth = frame.depth;
  Json json;
  json["t_ns"] = depth.t_ns;
  json["crop"] = {{"x", crop.x}, {"y", crop.y}, {"width", crop.width}, {"height", crop.height}};
  json["source"] = name(depth.source);
  json["reason"] = depth.reason;
  json["accumulation_s"] = number(depth.accumulation_s);
  json["predictions"] = depth.predictions;
  json["sim"] = number(depth.stereo.sim);
  json["sim_d"] = number(depth.stereo.sim_d);
  json["sim_pred"] = number(depth.stereo.sim_pred);
  json["sim_peak"] = number(depth.stereo.peak);
  json["sim_share"] = number(depth.stereo.share);
  json["stereo_verdict"] = name(depth.stereo_verdict);
  json["holdout_points"] = depth.holdout.points;
  json["holdout_median_m"] = holdout_json(depth.holdout, depth.holdout.median_m);
  json["holdout_error_m"] = holdout_json(depth.holdout, depth.holdout.rms_m);
  json["holdout_median_relative"] = holdout_json(depth.holdout, depth.holdout.median_relative);
  json["holdout_rms_relative"] = holdout_json(depth.holdout, depth.holdout.rms_relative);
  json["holdout_verdict"] = name(depth.holdout_verdict);
  json["site"] = site_json(frame);
  json["frame_sites"] = frame.selection ? sites_json(*frame.selection) : Json(nullptr);
  json["fused_sites"] = frame.fused ? sites_json(*frame.fused) : Json(nullptr);
  json["site_reason"] = frame.site_reason();
  json["wander"] = frame.decision.wander;
  json["health"] = to_json(frame.health);
  if (with_timings) {
    Json stages = Json::object();
    for (const auto& [stage, ms] : depth.stages_ms) stages[stage] = std::round(ms * 1e3) / 1e3;
    json["stages_ms"] = stages;
  }
  return json.dump();
}

std::string health_json(const HealthReport& health) { return to_json(health).dump(); }

ResultWriter::ResultWriter(const std::filesystem::path& path, const cv::Rect& crop, bool with_timings)
    : path_(path), stream_(path, std::ios::binary), crop_(crop), with_timings_(with_timings) {
  if (!stream_) throw DataError(path_.string() + ": cannot be written; check the folder and its rights");
}

void ResultWriter::write(const FrameReport& frame) {
  stream_ << to_json_line(frame, crop_, with_timings_) << '\n';
  stream_.flush();
  if (!stream_) throw DataError(path_.string() + ": cannot be written; check the free space");
}

void StageStatistics::add(const StageTimes& stages_ms) {
  for (const auto& [stage, ms] : stages_ms) samples_ms_[stage].push_back(ms);
}

double StageStatistics::percentile_ms(const std::string& stage, double share) const {
  return percentile(samples_ms_.at(stage), share);
}

std::string StageStatistics::table() const {
  std::string text = fmt::format("{:14} {:>8} {:>11} {:>9}\n", "stage", "frames", "median ms", "p95 ms");
  for (const auto& [stage, samples] : samples_ms_) {
    text += fmt::format("{:14} {:8} {:>11.2f} {:>9.2f}\n", stage, samples.size(), percentile(samples, 0.5),
                        percentile(samples, 0.95));
  }
  return text;
}

void ReplaySummary::add(const FrameReport& frame) {
  ++images;
  ++by_source[name(frame.depth.source)];
  if (frame.depth.source == DepthSource::kNone) {
    ++none_reasons[frame.depth.reason.substr(0, frame.depth.reason.find(';'))];
  }
  accumulation_s += frame.depth.accumulation_s * (frame.depth.source == DepthSource::kNone ? 0 : 1);
  sites += frame.decision.site ? 1 : 0;
  accepted += frame.decision.site && frame.decision.site->accepted ? 1 : 0;
  wandering += frame.decision.wander ? 1 : 0;
  stages.add(frame.depth.stages_ms);
}

std::string ReplaySummary::page() const {
  std::string text = fmt::format("images                 {:8}\n", images);
  std::int64_t with_depth = 0;
  for (const char* source : {"image", "lidar", "fallback", "none"}) {
    const auto found = by_source.find(source);
    const std::int64_t n = found == by_source.end() ? 0 : found->second;
    if (std::string(source) != "none") with_depth += n;
    text += fmt::format("  source {:13} {:8} {:>6.1f} %\n", source, n,
                        images > 0 ? 100.0 * static_cast<double>(n) / static_cast<double>(images) : 0.0);
  }
  for (const auto& [reason, n] : none_reasons) text += fmt::format("    none: {:60} {:8}\n", reason, n);
  if (with_depth > 0) {
    text +=
        fmt::format("mean LiDAR accumulation {:.3f} s\n", accumulation_s / static_cast<double>(with_depth));
  }
  text += fmt::format("frames with a site     {:8}, accepted {}, wandering {}\n", sites, accepted, wandering);
  if (live) {
    text += fmt::format(
        "in real time           {:>8.1f} images/s; from arrival to result {:.0f} ms (median), {:.0f} ms "
        "(p95), {:.0f} ms at most\n",
        static_cast<double>(live->images) / live_s, live->latency_ms(0.5), live->latency_ms(0.95),
        live->max_latency_ms);
  }
  for (const auto& [reason, n] : left_out) text += fmt::format("left out               {:8} {}\n", n, reason);
  return text + "\n" + stages.table();
}

}  // namespace alight
