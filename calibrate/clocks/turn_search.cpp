#include "calibrate/clocks/turn_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPoints = 6000;   // are enough for the search
constexpr double kTurnStep_deg = 0.15;  // a pixel
constexpr double kRollStep_deg = 0.5;   // points lie within 20 deg of the axis
constexpr double kHill_deg = 1;         // a true maximum slopes off so far

double total(const std::vector<double>& scores) { return std::accumulate(scores.begin(), scores.end(), 0.0); }

std::vector<double> steps(double reach, double step) {
  const int count = static_cast<int>(std::ceil(reach / step));
  std::vector<double> values;
  for (int i = -count; i <= count; ++i) values.push_back(i * step);
  return values;
}

}  // namespace

Eigen::Isometry3d turn_about_camera(const Vector3d& turn_rad) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const double angle = turn_rad.norm();
  if (angle > 0) motion.rotate(Eigen::AngleAxisd(angle, turn_rad / angle));
  return motion;
}

TurnSearch search_turns(const EdgeAgreement& agreement, double reach_deg) {
  const std::size_t every_nth = agreement.points() / kPoints + 1;
  const std::vector<double> turns = steps(reach_deg, kTurnStep_deg);
  std::vector<std::pair<Vector3d, double>> scores;
  for (const double z_deg : steps(reach_deg, kRollStep_deg)) {
    for (const double y_deg : turns) {
      for (const double x_deg : turns) {
        const Vector3d deg(x_deg, y_deg, z_deg);
        scores.emplace_back(deg,
                            total(agreement.scores(turn_about_camera(deg * kRadiansPerDegree), every_nth)));
      }
    }
  }
  TurnSearch search;
  const auto best = std::max_element(scores.begin(), scores.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  search.best_rad = best->first * kRadiansPerDegree;
  search.best = best->second;
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const auto& [deg, score] : scores) {
    if ((deg - best->first).head<2>().norm() < kHill_deg) continue;
    sum += score;
    squares += score * score;
    ++count;
  }
  search.chance = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - search.chance * search.chance));
  search.stands_out = (search.best - search.chance) / std::max(deviation, 1e-9);
  return search;
}

}  // namespace alight
