#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "train/evaluation/self/roc.hpp"
#include "train/evaluation/self/self_scores.hpp"

namespace alight {

/// A number that a depth map may be accepted by.
struct Criterion {
  const char* title;
  /// Larger: rather accepted; minus infinity: no evidence.
  double (*score)(const MapScores& map, const SelfEvaluationConfig& tests);
};
/// The paper's two rules, both together, the probe, and the hold-out test's two errors.
const std::vector<Criterion>& criteria();

/// A decision that the onboard loop can take, with the thresholds of its configuration.
struct Decision {
  const char* title;
  Verdict (*decide)(const MapScores& map, const SelfEvaluationConfig& tests);
};
/// The paper's rules alone, and every `decide_by`.
const std::vector<Decision>& decisions();

/// What the self-evaluation said of all maps, beside their true errors.
struct SelfReport {
  std::vector<std::pair<std::string, std::string>> about;  ///< for the head
  std::string command;                                     ///< that makes it again
  std::string figure;                                      ///< file name to show; empty: none
  SelfScoreConfig config;
  std::vector<MapScores> maps;
};

/// Pointers into a report.
using MapList = std::vector<const MapScores*>;
/// The network's own maps, or all of them.
MapList chosen_maps(const SelfReport& report, bool own_alone);

/// @param definition of GoodDepth, in the order of the configuration
FlightCases cases_of(const MapList& maps, const Criterion& criterion, const SelfEvaluationConfig& tests,
                     std::size_t definition = 0);

/// How often a decision accepts, in shares; NaN where there is no such map.
struct DecisionRates {
  double recall = 0;             ///< accepted share of the good maps
  double false_accept_rate = 0;  ///< accepted share of the others
  double no_evidence = 0;        ///< share of all maps
};
DecisionRates rates_of(const MapList& maps, const Decision& decision, const SelfEvaluationConfig& tests,
                       std::size_t definition = 0);

/// One line a map, with a head.
std::string to_csv(const SelfReport& report);

}  // namespace alight
