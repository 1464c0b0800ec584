#include "calibrate/fitting/least_squares.hpp"

#include <ceres/covariance.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include "calibrate/fitting/pose_block.hpp"

namespace alight {
namespace {

/// Ceres writes to glog, which writes to the terminal. What fails is told by the messages of whoever called.
void silence_glog() {
  static const bool once = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace

std::optional<double> minimise(ceres::Problem& problem) {
  silence_glog();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // No BLAS: its sums depend on its threads.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() ? std::optional<double>(summary.final_cost) : std::nullopt;
}

std::optional<Eigen::MatrixXd> covariance(ceres::Problem& problem, const std::vector<const double*>& blocks) {
  silence_glog();
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  ceres::Covariance estimate(options);
  if (!estimate.Compute(blocks, &problem)) return std::nullopt;
  Eigen::Index size = 0;
  for (const double* block : blocks) size += problem.ParameterBlockTangentSize(block);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> C(size, size);
  estimate.GetCovarianceMatrixInTangentSpace(blocks, C.data());
  Eigen::Index at = 0;
  for (const double* block : blocks) {
    if (dynamic_cast<const PoseManifold*>(problem.GetManifold(block)) != nullptr) {
      // The tangent vector of Ceres' quaternions is half the rotation vector.
      C.middleRows<3>(at + 3) *= 2;
      C.middleCols<3>(at + 3) *= 2;
    }
    at += problem.ParameterBlockTangentSize(block);
  }
  return C;
}

}  // namespace alight
