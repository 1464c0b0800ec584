#include "train/evaluation/self/roc.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

namespace alight {

std::vector<RocPoint> roc_curve(std::vector<ScoredCase> cases) {
  std::sort(cases.begin(), cases.end(),
            [](const ScoredCase& a, const ScoredCase& b) { return a.score > b.score; });
  const auto good = std::count_if(cases.begin(), cases.end(), [](const ScoredCase& c) { return c.good; });
  const auto bad = static_cast<std::ptrdiff_t>(cases.size()) - good;
  if (good == 0 || bad == 0) return {};
  std::vector<RocPoint> curve{{std::numeric_limits<double>::infinity(), 0, 0}};
  double accepted_good = 0;
  double accepted_bad = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    (cases[i].good ? accepted_good : accepted_bad) += 1;
    if (i + 1 < cases.size() && cases[i + 1].score == cases[i].score) continue;
    curve.push_back(
        {cases[i].score, accepted_bad / static_cast<double>(bad), accepted_good / static_cast<double>(good)});
  }
  return curve;
}

std::optional<double> area_under_roc(const std::vector<ScoredCase>& cases) {
  const std::vector<RocPoint> curve = roc_curve(cases);
  if (curve.empty()) return std::nullopt;
  double area = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    area += (curve[i].false_accept_rate - curve[i - 1].false_accept_rate) *
            (curve[i].recall + curve[i - 1].recall) / 2;
  }
  return area;
}

std::optional<double> false_accept_rate_at(const std::vector<ScoredCase>& cases, double recall) {
  const std::vector<RocPoint> curve = roc_curve(cases);
  const auto found = std::find_if(curve.begin(), curve.end(), [&](const RocPoint& point) {
    return point.recall >= recall && point.threshold > -std::numeric_limits<double>::infinity();
  });
  if (found == curve.end()) return std::nullopt;
  return found->false_accept_rate;
}

std::vector<ScoredCase> pooled(const FlightCases& flights) {
  std::vector<ScoredCase> all;
  for (const auto& [flight, cases] : flights) all.insert(all.end(), cases.begin(), cases.end());
  return all;
}

std::optional<double> area_standard_error(const FlightCases& flights, int draws, std::uint64_t seed) {
  if (flights.size() < 2) return std::nullopt;
  std::mt19937_64 random(seed);
  std::vector<double> areas;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<ScoredCase> cases;
    for (std::size_t i = 0; i < flights.size(); ++i) {
      // The remainder, because what std::uniform_int_distribution draws differs from library to library.
      const auto flight = std::next(flights.begin(), static_cast<std::ptrdiff_t>(random() % flights.size()));
      cases.insert(cases.end(), flight->second.begin(), flight->second.end());
    }
    if (const auto area = area_under_roc(cases)) areas.push_back(*area);
  }
  if (areas.size() < 2 || 2 * areas.size() < static_cast<std::size_t>(draws)) return std::nullopt;
  double mean = 0;
  for (const double area : areas) mean += area / static_cast<double>(areas.size());
  double squares = 0;
  for (const double area : areas) squares += (area - mean) * (area - mean);
  return std::sqrt(squares / static_cast<double>(areas.size() - 1));
}

}  // namespace alight
