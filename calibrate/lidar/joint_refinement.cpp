#include "calibrate/lidar/joint_refinement.hpp"

#include <cmath>
#include <deque>
#include <limits>

#include <Eigen/Dense>
#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>

#include "calibrate/fitting/least_squares.hpp"
#include "calibrate/fitting/pose_block.hpp"

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Reprojection error of a corner over the camera's noise.
struct CornerResidual {
  Vector3d p_board;
  Vector2d pixel;
  const PinholeIntrinsics& intrinsics;
  double noise_px;

  template <class T>
  bool operator()(const T* T_camera_lidar, const T* T_lidar_board, T* residual) const {
    const Eigen::Matrix<T, 3, 1> p =
        PoseView<T>(T_camera_lidar) * (PoseView<T>(T_lidar_board) * p_board.cast<T>());
    residual[0] = (intrinsics.fx_px * p.x() / p.z() + intrinsics.cx_px - pixel.x()) / noise_px;
    residual[1] = (intrinsics.fy_px * p.y() / p.z() + intrinsics.cy_px - pixel.y()) / noise_px;
    return true;
  }
};

/// A board against what the LiDAR saw of it: motion in its own frame and range offset, whitened.
struct LidarResidual {
  Eigen::Isometry3d T_seen_lidar;
  double range_offset_m;
  LidarBoard::Covariance whitening;

  template <class T>
  bool operator()(const T* T_lidar_board, const T* board_offset_m, T* residual) const {
    const PoseView<T> pose(T_lidar_board);
    const Eigen::Quaternion<T> turn = Eigen::Quaterniond(T_seen_lidar.linear()).cast<T>() * pose.rotation;
    const std::array<T, 4> wxyz = {turn.w(), turn.x(), turn.y(), turn.z()};
    Eigen::Matrix<T, 7, 1> off;
    off.template head<3>() = T_seen_lidar.linear().cast<T>() * pose.translation + T_seen_lidar.translation();
    ceres::QuaternionToAngleAxis(wxyz.data(), off.data() + 3);
    off[6] = *board_offset_m - range_offset_m;
    Eigen::Map<Eigen::Matrix<T, 7, 1>> whitened(residual);
    whitened = whitening.cast<T>() * off;
    return true;
  }
};

/// The LiDAR's range offset against none, and a board's own against the LiDAR's, over what is expected.
struct OffsetResidual {
  double sigma_m;

  template <class T>
  bool operator()(const T* offset_m, T* residual) const {
    *residual = *offset_m / sigma_m;
    return true;
  }
  template <class T>
  bool operator()(const T* board_offset_m, const T* offset_m, T* residual) const {
    *residual = (*board_offset_m - *offset_m) / sigma_m;
    return true;
  }
};

/// The LiDAR's view of a board once its directions may be wrong by a small turn about the sensor.
LidarBoard::Covariance with_angle_bias(const LidarBoard& seen, double angle_bias_rad) {
  // A turn w about the LiDAR moves the board, in its own frame, by R^T (w x t) and turns it by R^T w.
  const Eigen::Matrix3d R = seen.T_lidar_board.linear();
  Eigen::Matrix<double, 7, 3> by_turn = Eigen::Matrix<double, 7, 3>::Zero();
  by_turn.topRows<3>() = -R.transpose() * skew(seen.T_lidar_board.translation());
  by_turn.middleRows<3>(3) = R.transpose();
  return seen.covariance + angle_bias_rad * angle_bias_rad * by_turn * by_turn.transpose();
}

/// The least-squares problem over the extrinsics, the LiDAR's range offset, and each board's pose and own offset.
class JointProblem {
 public:
  JointProblem(const Chessboard& board, const PinholeIntrinsics& intrinsics, const JointNoise& noise,
               const Eigen::Isometry3d& T_camera_lidar)
      : board_(board), intrinsics_(intrinsics), noise_(noise), T_camera_lidar_(pose_block(T_camera_lidar)) {
    problem_.AddParameterBlock(T_camera_lidar_.data(), 7, new PoseManifold);
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<OffsetResidual, 1, 1>(new OffsetResidual{noise.range_bias_m}),
        nullptr, &range_offset_m_);
  }

  /// @param turn maps the camera's order of corners to the LiDAR's
  void add(const BoardView& view, const Eigen::Isometry3d& turn) {
    const LidarBoard& seen = view.lidar;
    BoardBlocks& own = boards_.emplace_back(BoardBlocks{pose_block(seen.T_lidar_board), seen.range_offset_m});
    problem_.AddParameterBlock(own.T_lidar_board.data(), 7, new PoseManifold);
    for (int k = 0; k < board_.corners(); ++k) {
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerResidual, 2, 7, 7>(new CornerResidual{
                                    turn * board_.corner(k), view.pixels[static_cast<std::size_t>(k)],
                                    intrinsics_, noise_.camera_px}),
                                nullptr, T_camera_lidar_.data(), own.T_lidar_board.data());
    }
    const Eigen::LLT<LidarBoard::Covariance> root(with_angle_bias(seen, noise_.angle_bias_rad));
    problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<LidarResidual, 7, 7, 1>(new LidarResidual{
                                  seen.T_lidar_board.inverse(), seen.range_offset_m,
                                  root.matrixL().solve(LidarBoard::Covariance::Identity())}),
                              nullptr, own.T_lidar_board.data(), &own.range_offset_m);
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<OffsetResidual, 1, 1, 1>(new OffsetResidual{noise_.range_bias_m}),
        nullptr, &own.range_offset_m, &range_offset_m_);
  }

  /// @returns 1/2 chi square; not finite where the start does not have one
  double minimise() { return alight::minimise(problem_).value_or(std::numeric_limits<double>::infinity()); }
  /// Of (translation, rotation vector, range offset); infinite variances where the boards leave a direction free.
  LidarBoard::Covariance covariance() {
    if (const auto found = alight::covariance(problem_, {T_camera_lidar_.data(), &range_offset_m_}))
      return *found;
    LidarBoard::Covariance unknown = LidarBoard::Covariance::Zero();
    unknown.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return unknown;
  }

  Eigen::Isometry3d T_camera_lidar() const { return transform_of(T_camera_lidar_); }
  double range_offset_m() const { return range_offset_m_; }

 private:
  struct BoardBlocks {
    PoseBlock T_lidar_board;
    double range_offset_m;
  };

  const Chessboard& board_;
  const PinholeIntrinsics& intrinsics_;
  JointNoise noise_;
  PoseBlock T_camera_lidar_;
  double range_offset_m_ = 0;
  std::deque<BoardBlocks> boards_;  // which stay where they are
  ceres::Problem problem_;
};

/// Condition number once a metre and a radian are measured in what moves the image alike: the mean distance.
double scaled_condition(const Matrix6d& covariance, double distance_m) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  Vector6d scale;
  scale << Vector3d::Ones(), Vector3d::Constant(distance_m);
  const Matrix6d scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Vector6d values = Eigen::SelfAdjointEigenSolver<Matrix6d>(scaled).eigenvalues();
  return values.maxCoeff() / std::max(values.minCoeff(), 1e-300);
}

}  // namespace

JointResult refine_jointly(const Chessboard& board, const std::vector<JointBoard>& boards,
                           const PinholeIntrinsics& intrinsics, const JointNoise& noise,
                           const Eigen::Isometry3d& T_camera_lidar) {
  JointProblem problem(board, intrinsics, noise, T_camera_lidar);
  double distance_m = 0;
  for (const JointBoard& b : boards) {
    problem.add(*b.view, b.turn);
    distance_m += (b.view->lidar.T_lidar_board * board.centre()).norm() / static_cast<double>(boards.size());
  }
  const double cost = problem.minimise();
  const LidarBoard::Covariance covariance = problem.covariance();
  JointResult result;
  result.T_camera_lidar = problem.T_camera_lidar();
  // Residuals: two a corner, seven and one a board, one offset. Parameters: seven, and seven a board.
  const double freedom = static_cast<double>(boards.size()) * (2.0 * board.corners() + 1) - 6;
  result.excess = std::sqrt(2 * cost / std::max(1.0, freedom));
  const double widen = std::max(1.0, result.excess * result.excess);
  result.covariance = widen * covariance.topLeftCorner<6, 6>();
  result.range_offset_m = problem.range_offset_m();
  result.range_offset_sigma_m = std::sqrt(widen * covariance(6, 6));
  result.camera_noise_px = noise.camera_px;
  result.condition = scaled_condition(result.covariance, distance_m);
  return result;
}

Matrix6d board_information(const Chessboard& board, const BoardView& view,
                           const Eigen::Isometry3d& T_camera_lidar, const PinholeIntrinsics& intrinsics,
                           const JointNoise& noise) {
  JointProblem problem(board, intrinsics, noise, T_camera_lidar);
  problem.add(view, Eigen::Isometry3d::Identity());
  const Matrix6d covariance = problem.covariance().topLeftCorner<6, 6>();
  return covariance.allFinite() ? Matrix6d(covariance.inverse()) : Matrix6d(Matrix6d::Zero());
}

}  // namespace alight
