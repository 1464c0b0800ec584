#include "calibrate/edge_check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dataset/score_peak.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kBlocks = 20;  // stretches of the flight, for the scatter of the result
constexpr std::size_t kCoarsePoints = 6000;
constexpr double kTurnStep_deg = 0.15;  // of the search: a pixel
constexpr double kRollStep_deg = 0.5;   // points lie within 20 deg of the axis
constexpr double kNeighbourhood_deg = 0.3;
constexpr double kRollNeighbourhood_deg = 0.8;
constexpr double kNeighbourhood_m = 0.1;
constexpr double kHill_deg = 1;   // a true maximum slopes off so far
constexpr double kSharper = 0.5;  // the neighbourhood of the second climb

double total(const std::vector<double>& scores) { return std::accumulate(scores.begin(), scores.end(), 0.0); }

/// Views that follow each other share LiDAR points and what they look at.
VectorXd in_blocks(const std::vector<double>& scores) {
  const std::size_t blocks = std::min<std::size_t>(kBlocks, scores.size());
  VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(blocks));
  for (std::size_t i = 0; i < scores.size(); ++i)
    sums[static_cast<Eigen::Index>(i * blocks / scores.size())] += scores[i];
  return sums;
}

std::vector<double> steps(double reach, double step) {
  const int count = static_cast<int>(std::ceil(reach / step));
  std::vector<double> values;
  for (int i = -count; i <= count; ++i) values.push_back(i * step);
  return values;
}

/// All turns of a grid.
struct TurnSearch {
  Vector3d best_deg = Vector3d::Zero();
  double best = 0;
  double chance = 0;      // mean of the scores away from the best
  double stands_out = 0;  // (best - chance) over the standard deviation of those
};

TurnSearch search_turns(const EdgeAgreement& agreement, double reach_deg) {
  const std::size_t every_nth = agreement.points() / kCoarsePoints + 1;
  const std::vector<double> turns = steps(reach_deg, kTurnStep_deg);
  std::vector<std::pair<Vector3d, double>> scores;
  for (const double z_deg : steps(reach_deg, kRollStep_deg)) {
    for (const double y_deg : turns) {
      for (const double x_deg : turns) {
        const Vector3d deg(x_deg, y_deg, z_deg);
        scores.emplace_back(
            deg, total(agreement.scores(motion_of(deg * kRadiansPerDegree, Vector3d::Zero()), every_nth)));
      }
    }
  }
  TurnSearch search;
  const auto best = std::max_element(scores.begin(), scores.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  search.best_deg = best->first;
  search.best = best->second;
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const auto& [deg, score] : scores) {
    if ((deg - search.best_deg).head<2>().norm() < kHill_deg) continue;
    sum += score;
    squares += score * score;
    ++count;
  }
  search.chance = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - search.chance * search.chance));
  search.stands_out = (search.best - search.chance) / std::max(deviation, 1e-9);
  return search;
}

/// Widely, not to be caught by a bump, then sharply, because a wide hill need not be even.
ScorePeak climb_twice(const BlockScores& scores, const VectorXd& start, const VectorXd& step) {
  const ScorePeak wide = climb(scores, start, step);
  if (!wide.found) return wide;
  const ScorePeak sharp = climb(scores, wide.at, kSharper * step);
  return sharp.found ? sharp : wide;
}

Betterment to_betterment(const ScorePeak& peak) { return {peak.found, peak.at, peak.sigma()}; }

}  // namespace

void bind(Binder& b, EdgeCheckConfig& c) {
  b.field("window_s", c.window_s, "LiDAR edges measured within half of it of an image are held against it",
          positive());
  b.field("max_turn_deg", c.max_turn_deg, "searched about each axis", between(1.5, 10));
  b.field("min_edges", c.min_edges, "fewer say nothing", at_least(10));
  b.field("min_stands_out", c.min_stands_out,
          "the best score over those away from it, in their standard deviations", positive());
}

Eigen::Isometry3d motion_of(const Vector3d& turn_rad, const Vector3d& shift_m) {
  Vector6d motion;
  motion << shift_m, turn_rad;
  return small_motion(motion);
}

EdgeCheck check_edges(const EdgeAgreement& agreement, const EdgeCheckConfig& config) {
  EdgeCheck result;
  result.edges = static_cast<int>(agreement.points());
  result.views = static_cast<int>(agreement.views());
  if (result.edges < config.min_edges || result.views < 3) return result;
  result.score = total(agreement.scores(Eigen::Isometry3d::Identity()));
  const TurnSearch search = search_turns(agreement, config.max_turn_deg);
  result.chance = search.chance;
  result.stands_out = search.stands_out;
  const Vector3d step =
      Vector3d(kNeighbourhood_deg, kNeighbourhood_deg, kRollNeighbourhood_deg) * kRadiansPerDegree;
  const ScorePeak turn = climb_twice(
      [&](const VectorXd& at) { return in_blocks(agreement.scores(motion_of(at, Vector3d::Zero()))); },
      search.best_deg * kRadiansPerDegree, step);
  result.turn = to_betterment(turn);
  result.best_score = total(agreement.scores(motion_of(turn.at, Vector3d::Zero())));
  result.peak = turn.found && result.stands_out >= config.min_stands_out;
  if (!result.peak) return result;
  result.shift = to_betterment(
      climb_twice([&](const VectorXd& at) { return in_blocks(agreement.scores(motion_of(turn.at, at))); },
                  Vector3d::Zero(), Vector3d::Constant(kNeighbourhood_m)));
  return result;
}

}  // namespace alight
