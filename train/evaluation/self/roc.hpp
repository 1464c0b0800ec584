#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace alight {

/// What a test says of a thing that is good or not.
struct ScoredCase {
  double score =
      0;  ///< larger: rather accepted; minus infinity: no evidence, which no threshold accepts; never NaN
  bool good = false;
};

/// What happens when all cases with `score >= threshold` are accepted.
struct RocPoint {
  double threshold = 0;
  double false_accept_rate = 0;  ///< accepted share of the cases that are not good
  double recall = 0;             ///< accepted share of the good ones
};

/// Receiver operating characteristic (Fawcett, "An introduction to ROC analysis", 2006): from (0, 0) to (1, 1), a point a
/// different score, so that equal scores are accepted together. Empty unless there are good cases and others.
std::vector<RocPoint> roc_curve(std::vector<ScoredCase> cases);

/// The probability that a good case has a higher score than one that is not; equal scores count half.
std::optional<double> area_under_roc(const std::vector<ScoredCase>& cases);

/// Of the threshold that accepts the least and still at least `recall` of the good cases. None where there is no such
/// threshold, because too many good cases come without evidence.
std::optional<double> false_accept_rate_at(const std::vector<ScoredCase>& cases, double recall);

/// Cases by flight. Those of one flight are no independent draws, flights are nearly.
using FlightCases = std::map<std::string, std::vector<ScoredCase>>;
std::vector<ScoredCase> pooled(const FlightCases& flights);

/// Standard error of the area over the pooled cases, by drawing as many flights with replacement (bootstrap), always the
/// same for one seed. None with fewer than two flights, or where hardly any draw has an area.
std::optional<double> area_standard_error(const FlightCases& flights, int draws = 200,
                                          std::uint64_t seed = 1);

}  // namespace alight
