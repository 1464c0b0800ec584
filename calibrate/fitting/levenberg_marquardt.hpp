#pragma once

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace alight {

/// Gauss-Newton's normal equations of a least-squares problem at one state: cost = 1/2 sum r^2, H = J^T J, g = J^T r.
struct NormalEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  double cost = 0;
};

struct LevenbergMarquardtOptions {
  int max_iterations = 50;
  double relative_decrease = 1e-10;  ///< of the cost, below which the search has converged
};

/// Minimises a least-squares cost over any state that can be moved by a vector (Madsen, Nielsen, Tingleff, "Methods for
/// Non-Linear Least Squares Problems", 2004, section 3.2, with Marquardt's diagonal scaling).
/// @param linearise state -> NormalEquations
/// @param cost state -> 1/2 sum r^2
/// @param moved (state, step) -> state
/// @returns the normal equations at the minimum; `state` is the minimum
template <class State, class Linearise, class Cost, class Moved>
NormalEquations minimise(State& state, const Linearise& linearise, const Cost& cost, const Moved& moved,
                         const LevenbergMarquardtOptions& options = {}) {
  double damping = 1e-4;
  NormalEquations at = linearise(state);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    bool better = false;
    double decrease = 0;
    for (int attempt = 0; attempt < 10 && !better; ++attempt) {
      Eigen::MatrixXd damped = at.H;
      damped.diagonal() += damping * (at.H.diagonal().array() + 1e-12).matrix();
      const Eigen::VectorXd step = damped.ldlt().solve(-at.g);
      const State candidate = moved(state, step);
      const double new_cost = step.allFinite() ? cost(candidate) : at.cost;
      better = std::isfinite(new_cost) && new_cost < at.cost;
      damping = better ? std::fmax(damping * 0.2, 1e-12) : damping * 10;
      if (!better) continue;
      decrease = at.cost - new_cost;
      state = candidate;
    }
    if (!better) break;
    const double before = at.cost;
    at = linearise(state);
    if (decrease < options.relative_decrease * before) break;
  }
  return at;
}

}  // namespace alight
