#include "calibrate/check/edge_check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibrate/clocks/score_peak.hpp"
#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kNeighbourhood_deg = 0.3;
constexpr double kRollNeighbourhood_deg = 0.8;
constexpr double kNeighbourhood_m = 0.1;
constexpr double kSharper = 0.5;  // the neighbourhood of the second climb

double total(const std::vector<double>& scores) { return std::accumulate(scores.begin(), scores.end(), 0.0); }

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
      search.best_rad, step);
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
