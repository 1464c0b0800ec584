#include "train/evaluation/self/self_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace alight {
namespace {

constexpr double kNoEvidence = -std::numeric_limits<double>::infinity();

/// sim_pred - (sim + sim_d) / 2
double first_rule(const MapScores& map, const SelfEvaluationConfig& tests) {
  const StereoScores& s = map.stereo;
  if (!s.sim || !s.sim_d || !s.sim_pred || s.share < tests.stereo.min_share) return kNoEvidence;
  return *s.sim_pred - (*s.sim + *s.sim_d) / 2;
}

/// sim_pred - sim - min_gain
double second_rule(const MapScores& map, const SelfEvaluationConfig& tests) {
  const StereoScores& s = map.stereo;
  if (!s.sim || !s.sim_pred || s.share < tests.stereo.min_share) return kNoEvidence;
  return *s.sim_pred - *s.sim - tests.stereo.min_gain;
}

double either_rule(const MapScores& map, const SelfEvaluationConfig& tests) {
  return std::max(first_rule(map, tests), second_rule(map, tests));
}

double peak(const MapScores& map, const SelfEvaluationConfig&) {
  return map.stereo.peak.value_or(kNoEvidence);
}

double holdout_median(const MapScores& map, const SelfEvaluationConfig& tests) {
  return map.holdout.points < tests.holdout.min_points ? kNoEvidence : -map.holdout.median_relative;
}

double holdout_rms(const MapScores& map, const SelfEvaluationConfig& tests) {
  return map.holdout.points < tests.holdout.min_points ? kNoEvidence : -map.holdout.rms_relative;
}

Verdict paper(const MapScores& map, const SelfEvaluationConfig& tests) {
  if (!map.stereo.sim_pred) return Verdict::kNoEvidence;
  return paper_accepts(map.stereo, tests.stereo) ? Verdict::kAccept : Verdict::kReject;
}

/// A simulated LiDAR never falls silent.
template <DecideBy decide_by>
Verdict by(const MapScores& map, const SelfEvaluationConfig&) {
  return decide(map.stereo_verdict, map.holdout_verdict, /*lidar_silent=*/false, decide_by);
}

std::string number(double value) {
  if (!std::isfinite(value)) return "";
  return fmt::format("{:.6g}", value);
}

std::string number(const std::optional<double>& value) { return value ? number(*value) : ""; }

}  // namespace

const std::vector<Criterion>& criteria() {
  static const std::vector<Criterion> kCriteria{
      {"paper, rule 1", first_rule}, {"paper, rule 2", second_rule},      {"paper, either rule", either_rule},
      {"probe (peak)", peak},        {"hold-out median", holdout_median}, {"hold-out RMS", holdout_rms}};
  return kCriteria;
}

const std::vector<Decision>& decisions() {
  static const std::vector<Decision> kDecisions{{"paper's rules alone", paper},
                                                {"stereo", by<DecideBy::kStereo>},
                                                {"lidar_holdout", by<DecideBy::kLidarHoldout>},
                                                {"either", by<DecideBy::kEither>},
                                                {"both", by<DecideBy::kBoth>}};
  return kDecisions;
}

MapList chosen_maps(const SelfReport& report, bool own_alone) {
  MapList maps;
  for (const MapScores& map : report.maps) {
    if (!own_alone || map.origin == MapOrigin::kNetwork) maps.push_back(&map);
  }
  return maps;
}

FlightCases cases_of(const MapList& maps, const Criterion& criterion, const SelfEvaluationConfig& tests,
                     std::size_t definition) {
  FlightCases cases;
  for (const MapScores* map : maps) {
    const double score = criterion.score(*map, tests);
    cases[map->flight].push_back({std::isnan(score) ? kNoEvidence : score, map->good.at(definition)});
  }
  return cases;
}

DecisionRates rates_of(const MapList& maps, const Decision& decision, const SelfEvaluationConfig& tests,
                       std::size_t definition) {
  double good = 0, accepted_good = 0, accepted_bad = 0, no_evidence = 0;
  for (const MapScores* map : maps) {
    const Verdict verdict = decision.decide(*map, tests);
    const bool is_good = map->good.at(definition);
    good += is_good ? 1 : 0;
    if (verdict == Verdict::kAccept) (is_good ? accepted_good : accepted_bad) += 1;
    if (verdict == Verdict::kNoEvidence) no_evidence += 1;
  }
  const auto count = static_cast<double>(maps.size());
  return {accepted_good / good, accepted_bad / (count - good), no_evidence / count};
}

std::string to_csv(const SelfReport& report) {
  std::string text = "flight,sample,window_s,map,depth_m";
  for (std::size_t i = 0; i < report.config.good.size(); ++i) {
    const std::string n = std::to_string(i + 1);
    text += ",share_within_" + n + ",good_" + n;
  }
  text +=
      ",sim,sim_d,sim_pred,share,peak,holdout_points,holdout_median_relative,holdout_rms_relative,stereo,"
      "holdout\n";
  for (const MapScores& map : report.maps) {
    text += map.flight + "," + std::to_string(map.sample) + "," + number(map.window_s) + "," +
            name(map.origin) + "," + number(map.depth_m);
    for (std::size_t i = 0; i < map.good.size(); ++i) {
      text += "," + number(map.share_within[i]) + "," + (map.good[i] ? "1" : "0");
    }
    const StereoScores& s = map.stereo;
    text += "," + number(s.sim) + "," + number(s.sim_d) + "," + number(s.sim_pred) + "," + number(s.share) +
            "," + number(s.peak) + "," + std::to_string(map.holdout.points) + "," +
            number(map.holdout.median_relative) + "," + number(map.holdout.rms_relative) + "," +
            name(map.stereo_verdict) + "," + name(map.holdout_verdict) + "\n";
  }
  return text;
}

}  // namespace alight
