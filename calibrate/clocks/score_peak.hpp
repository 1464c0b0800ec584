#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace alight {

/// A score that is a sum over blocks of independent evidence (such as stretches of a flight): what each adds at a point
/// of the searched space. [number of blocks]
using BlockScores = std::function<Eigen::VectorXd(const Eigen::VectorXd& at)>;

/// Scores of images, added up over at most 20 stretches of a flight: images that follow each other share LiDAR points and what
/// they look at, and are not independent.
Eigen::VectorXd in_blocks(const std::vector<double>& scores);

/// A maximum of a score.
struct ScorePeak {
  bool found = false;  ///< a maximum near the start: the score falls off in every direction
  Eigen::VectorXd at;  ///< found or not, the best place seen
  Eigen::MatrixXd
      covariance;  ///< of `at`, from how the blocks differ (delete-one jackknife); zero where not found

  Eigen::VectorXd sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// Climbs from `start` to the maximum of the quadratic that fits the score within `step` on every side, again and again
/// until it stays. A score that is jagged at the scale of `step` is smoothed by it.
/// @param start [n]. @param step [n], positive: half the size of the neighbourhood along each axis
ScorePeak climb(const BlockScores& scores, const Eigen::VectorXd& start, const Eigen::VectorXd& step);

}  // namespace alight
