#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace ceres {
class Problem;
}

namespace alight {

/// Moves a problem's parameters to a minimum of 1/2 sum r^2, by Levenberg-Marquardt on one thread: the same bits every
/// time. @returns the cost there; empty where the residuals of the start are not finite
std::optional<double> minimise(ceres::Problem& problem);

/// Covariance of some of a problem's parameter blocks, one after the other, where its parameters are: the inverse of
/// J^T J, all other blocks marginalised. A PoseBlock has six rows: translation [m], rotation vector [rad], the turned
/// pose being Exp(w) R. @returns empty where the residuals leave a direction free
std::optional<Eigen::MatrixXd> covariance(ceres::Problem& problem, const std::vector<const double*>& blocks);

}  // namespace alight
