#include "calibrate/clocks/score_peak.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Vector3d kPeak(0.4, -1.1, 2.0);

TEST(ScorePeak, FindsTheTopOfAParaboloidExactly) {
  const auto score = [](const VectorXd& x) {
    const Vector3d off = x - kPeak;
    return VectorXd::Constant(
        4, -(off.x() * off.x() + 2 * off.y() * off.y() + off.z() * off.z() + off.x() * off.y()));
  };
  const ScorePeak peak = climb(score, Vector3d::Zero(), Vector3d::Constant(0.5));
  ASSERT_TRUE(peak.found);
  EXPECT_TRUE(peak.at.isApprox(kPeak, 1e-9));
  EXPECT_LT(peak.sigma().maxCoeff(), 1e-6);  // blocks agree
}

TEST(ScorePeak, StandardDeviationIsThatOfTheBlocksMean) {
  // Each block has its own opinion on the place; of equal curvature, the sum's top is their mean.
  constexpr int kBlocks = 40;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.1);
  std::vector<double> wishes;
  double mean = 0;
  for (int b = 0; b < kBlocks; ++b) {
    wishes.push_back(normal(random));
    mean += wishes.back() / kBlocks;
  }
  double squares = 0;
  for (const double wish : wishes) squares += (wish - mean) * (wish - mean);
  const auto score = [&](const VectorXd& x) {
    VectorXd scores(kBlocks);
    for (int b = 0; b < kBlocks; ++b)
      scores[b] = -std::pow(x[0] - wishes[static_cast<std::size_t>(b)], 2) - x[1] * x[1];
    return scores;
  };
  const ScorePeak peak = climb(score, Vector2d(0.3, 0.2), Vector2d(0.2, 0.2));
  ASSERT_TRUE(peak.found);
  EXPECT_NEAR(peak.at[0], mean, 1e-9);
  EXPECT_NEAR(peak.sigma()[0], std::sqrt(squares / (kBlocks - 1) / kBlocks), 1e-6);
}

TEST(ScorePeak, FlatAndRisingScoresHaveNone) {
  const auto flat = [](const VectorXd&) { return VectorXd::Zero(5); };
  EXPECT_FALSE(climb(flat, Vector2d::Zero(), Vector2d::Ones()).found);
  const auto slope = [](const VectorXd& x) { return VectorXd::Constant(5, x[0]); };
  EXPECT_FALSE(climb(slope, Vector2d::Zero(), Vector2d::Ones()).found);
}

TEST(ScorePeak, ARidgeIsNoPeak) {
  const auto ridge = [](const VectorXd& x) { return VectorXd::Constant(5, -x[0] * x[0]); };
  const ScorePeak peak = climb(ridge, Vector2d(0.2, 0), Vector2d::Ones());
  // Along the ridge nothing holds the place: either none is found or its standard deviation says so.
  EXPECT_TRUE(!peak.found || peak.sigma()[1] > 1);
}

}  // namespace
}  // namespace alight
