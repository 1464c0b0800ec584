#include "calibrate/clocks/score_peak.hpp"

#include <algorithm>

#include <Eigen/Dense>

namespace alight {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points of the neighbourhood, in units of its half size: the middle, and along every axis and every diagonal of two axes
/// at half and full size.
std::vector<VectorXd> design(Index n) {
  std::vector<VectorXd> points = {VectorXd::Zero(n)};
  for (const double size : {0.5, 1.0}) {
    for (Index i = 0; i < n; ++i) {
      for (const double sign : {-1.0, 1.0}) {
        points.emplace_back(sign * size * VectorXd::Unit(n, i));
        for (Index k = 0; k < i; ++k) {
          points.emplace_back(sign * size * (VectorXd::Unit(n, i) + VectorXd::Unit(n, k)));
          points.emplace_back(sign * size * (VectorXd::Unit(n, i) - VectorXd::Unit(n, k)));
        }
      }
    }
  }
  return points;
}

/// 1, x_i, x_i x_k
VectorXd monomials(const VectorXd& x) {
  const Index n = x.size();
  VectorXd m(1 + n + n * (n + 1) / 2);
  m[0] = 1;
  m.segment(1, n) = x;
  Index at = 1 + n;
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k <= i; ++k) m[at++] = x[i] * x[k];
  }
  return m;
}

/// The maximum of the quadratic with these coefficients, kept inside the neighbourhood. @returns whether it has one
bool maximum(const VectorXd& coefficients, Index n, VectorXd& x) {
  const VectorXd gradient = coefficients.segment(1, n);
  MatrixXd H(n, n);
  Index at = 1 + n;
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k <= i; ++k) {
      H(i, k) = H(k, i) = coefficients[at] * (i == k ? 2 : 1);
      ++at;
    }
  }
  const Eigen::LDLT<MatrixXd> ldlt(-H);
  if (!ldlt.isPositive() || ldlt.vectorD().minCoeff() <= 0) return false;
  x = ldlt.solve(gradient);
  const double reach = x.cwiseAbs().maxCoeff();
  if (reach > 1) x /= reach;
  return true;
}

MatrixXd jackknife(const MatrixXd& coefficients, Index n) {
  const Index blocks = coefficients.cols();
  const VectorXd all = coefficients.rowwise().sum();
  MatrixXd places(n, blocks);
  for (Index b = 0; b < blocks; ++b) {
    VectorXd x = VectorXd::Zero(n);
    if (!maximum(all - coefficients.col(b), n, x))
      x.setOnes();  // without this block there would be no maximum
    places.col(b) = x;
  }
  const MatrixXd off = places.colwise() - places.rowwise().mean();
  return off * off.transpose() * static_cast<double>(blocks - 1) / static_cast<double>(blocks);
}

}  // namespace

VectorXd in_blocks(const std::vector<double>& scores) {
  constexpr std::size_t kBlocks = 20;
  const std::size_t blocks = std::min(kBlocks, scores.size());
  VectorXd sums = VectorXd::Zero(static_cast<Index>(blocks));
  for (std::size_t i = 0; i < scores.size(); ++i)
    sums[static_cast<Index>(i * blocks / scores.size())] += scores[i];
  return sums;
}

ScorePeak climb(const BlockScores& scores, const VectorXd& start, const VectorXd& step) {
  constexpr int kMaxRounds = 20;
  constexpr double kStays = 0.02;  // of the neighbourhood
  const Index n = start.size();
  const std::vector<VectorXd> points = design(n);
  MatrixXd A(static_cast<Index>(points.size()), 1 + n + n * (n + 1) / 2);
  for (std::size_t i = 0; i < points.size(); ++i) A.row(static_cast<Index>(i)) = monomials(points[i]);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  ScorePeak peak{false, start, MatrixXd::Zero(n, n)};
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<VectorXd> sampled;
    for (const VectorXd& point : points) sampled.push_back(scores(peak.at + step.cwiseProduct(point)));
    MatrixXd Y(static_cast<Index>(points.size()), sampled.front().size());
    for (std::size_t i = 0; i < points.size(); ++i) Y.row(static_cast<Index>(i)) = sampled[i];
    const MatrixXd coefficients = qr.solve(Y);
    VectorXd x = VectorXd::Zero(n);
    if (!maximum(coefficients.rowwise().sum(), n, x)) {
      Index best = 0;
      Y.rowwise().sum().maxCoeff(&best);
      if (best == 0) return peak;
      x = points[static_cast<std::size_t>(best)];
    } else if (x.cwiseAbs().maxCoeff() < kStays ||
               (round + 1 == kMaxRounds && x.cwiseAbs().maxCoeff() < 0.5)) {
      peak.found = true;
      peak.at += step.cwiseProduct(x);
      peak.covariance = step.asDiagonal() * jackknife(coefficients, n) * step.asDiagonal();
      return peak;
    }
    peak.at += step.cwiseProduct(x);
  }
  return peak;
}

}  // namespace alight
