#include "calibrate/lidar/joint_refinement.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "calibrate/fitting/levenberg_marquardt.hpp"

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Jacobian2x6 = Eigen::Matrix<double, 2, 6>;
constexpr int kShared = 7;  // mounting, range offset
constexpr int kPerBoard = 7;

struct JointState {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  double range_offset_m = 0;
  std::vector<Eigen::Isometry3d> T_lidar_board;
  std::vector<double> board_offset_m;
};

JointState moved(const JointState& state, const Eigen::VectorXd& step) {
  JointState result = state;
  result.T_camera_lidar.linear() = rotation_exp(step.segment<3>(3)) * state.T_camera_lidar.linear();
  result.T_camera_lidar.translation() += step.head<3>();
  result.range_offset_m += step[6];
  for (std::size_t i = 0; i < state.T_lidar_board.size(); ++i) {
    const auto at = kShared + kPerBoard * static_cast<Eigen::Index>(i);
    result.T_lidar_board[i] = state.T_lidar_board[i] * small_motion(step.segment<6>(at));
    result.board_offset_m[i] += step[at + 6];
  }
  return result;
}

/// Pixel of a board's corner with its derivatives by mounting and board pose.
struct Projected {
  Vector2d pixel;
  Jacobian2x6 by_mounting;
  Jacobian2x6 by_board;
};

Projected project(const Vector3d& p_board, const Eigen::Isometry3d& T_camera_lidar,
                  const Eigen::Isometry3d& T_lidar_board, const PinholeIntrinsics& intrinsics) {
  const Vector3d p = T_camera_lidar * (T_lidar_board * p_board);
  Eigen::Matrix<double, 2, 3> J;
  J << intrinsics.fx_px / p.z(), 0, -intrinsics.fx_px * p.x() / (p.z() * p.z()), 0, intrinsics.fy_px / p.z(),
      -intrinsics.fy_px * p.y() / (p.z() * p.z());
  Projected result;
  result.pixel = intrinsics.project(p);
  result.by_mounting << J, -J * skew(p - T_camera_lidar.translation());
  const Eigen::Matrix3d R = (T_camera_lidar * T_lidar_board).linear();
  result.by_board << J * R, -J * R * skew(p_board);
  return result;
}

/// The LiDAR's view of a board once its directions may be wrong by a small turn about the sensor.
LidarBoard::Information with_angle_bias(const LidarBoard::Information& information,
                                        const Eigen::Isometry3d& T_lidar_board, double angle_bias_rad) {
  // A turn w about the LiDAR moves the board, in its own frame, by R^T (w x t) and turns it by R^T w.
  const Eigen::Matrix3d R = T_lidar_board.linear();
  Eigen::Matrix<double, 7, 3> by_turn = Eigen::Matrix<double, 7, 3>::Zero();
  by_turn.topRows<3>() = -R.transpose() * skew(T_lidar_board.translation());
  by_turn.middleRows<3>(3) = R.transpose();
  // Woodbury: (C + s^2 G G^T)^-1 without inverting the information, one direction of which is weak.
  const Eigen::Matrix3d inner = Eigen::Matrix3d::Identity() / (angle_bias_rad * angle_bias_rad) +
                                by_turn.transpose() * information * by_turn;
  return information - information * by_turn * inner.ldlt().solve(by_turn.transpose() * information);
}

class Problem {
 public:
  Problem(const Chessboard& board, const std::vector<JointBoard>& boards, const PinholeIntrinsics& intrinsics,
          const JointNoise& noise)
      : board_(board), boards_(boards), intrinsics_(intrinsics), noise_(noise) {
    for (const JointBoard& b : boards)
      information_.push_back(
          with_angle_bias(b.view->lidar.information, b.view->lidar.T_lidar_board, noise.angle_bias_rad));
  }

  NormalEquations linearise(const JointState& state) const {
    const auto size = kShared + kPerBoard * static_cast<Eigen::Index>(boards_.size());
    NormalEquations out{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), 0};
    add_offset_prior(state, out);
    for (std::size_t i = 0; i < boards_.size(); ++i) {
      add_corners(state, i, out);
      add_lidar(state, i, out);
    }
    return out;
  }
  double cost(const JointState& state) const { return linearise(state).cost; }

 private:
  void add_offset_prior(const JointState& state, NormalEquations& out) const {
    const double weight = 1 / (noise_.range_bias_m * noise_.range_bias_m);
    out.H(6, 6) += weight;
    out.g[6] += weight * state.range_offset_m;
    out.cost += 0.5 * weight * state.range_offset_m * state.range_offset_m;
  }

  void add_corners(const JointState& state, std::size_t i, NormalEquations& out) const {
    const auto at = kShared + kPerBoard * static_cast<Eigen::Index>(i);
    for (int k = 0; k < board_.corners(); ++k) {
      const Projected p = project(boards_[i].turn * board_.corner(k), state.T_camera_lidar,
                                  state.T_lidar_board[i], intrinsics_);
      const Vector2d r = (p.pixel - boards_[i].view->pixels[static_cast<std::size_t>(k)]) / noise_.camera_px;
      const Jacobian2x6 Jm = p.by_mounting / noise_.camera_px;
      const Jacobian2x6 Jb = p.by_board / noise_.camera_px;
      out.H.topLeftCorner<6, 6>() += Jm.transpose() * Jm;
      out.H.block<6, 6>(at, at) += Jb.transpose() * Jb;
      out.H.block<6, 6>(0, at) += Jm.transpose() * Jb;
      out.H.block<6, 6>(at, 0) += Jb.transpose() * Jm;
      out.g.head<6>() += Jm.transpose() * r;
      out.g.segment<6>(at) += Jb.transpose() * r;
      out.cost += 0.5 * r.squaredNorm();
    }
  }

  void add_lidar(const JointState& state, std::size_t i, NormalEquations& out) const {
    const auto at = kShared + kPerBoard * static_cast<Eigen::Index>(i);
    const LidarBoard& seen = boards_[i].view->lidar;
    Eigen::Matrix<double, 7, 1> off;
    off << motion_vector(seen.T_lidar_board.inverse() * state.T_lidar_board[i]),
        state.board_offset_m[i] - seen.range_offset_m;
    out.H.block<7, 7>(at, at) += information_[i];
    out.g.segment<7>(at) += information_[i] * off;
    out.cost += 0.5 * off.dot(information_[i] * off);
    const double weight = 1 / (noise_.range_bias_m * noise_.range_bias_m);
    const double own = state.board_offset_m[i] - state.range_offset_m;
    out.H(at + 6, at + 6) += weight;
    out.H(6, 6) += weight;
    out.H(at + 6, 6) -= weight;
    out.H(6, at + 6) -= weight;
    out.g[at + 6] += weight * own;
    out.g[6] -= weight * own;
    out.cost += 0.5 * weight * own * own;
  }

  const Chessboard& board_;
  const std::vector<JointBoard>& boards_;
  const PinholeIntrinsics& intrinsics_;
  JointNoise noise_;
  std::vector<LidarBoard::Information> information_;
};

/// Condition number once a metre and a radian are measured in what moves the image alike: the mean distance.
double scaled_condition(const Matrix6d& covariance, double distance_m) {
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
  JointState state;
  state.T_camera_lidar = T_camera_lidar;
  double distance_m = 0;
  for (const JointBoard& b : boards) {
    state.T_lidar_board.push_back(b.view->lidar.T_lidar_board);
    state.board_offset_m.push_back(b.view->lidar.range_offset_m);
    distance_m += (b.view->lidar.T_lidar_board * board.centre()).norm() / static_cast<double>(boards.size());
  }
  const Problem problem(board, boards, intrinsics, noise);
  const NormalEquations end = minimise(
      state, [&](const JointState& s) { return problem.linearise(s); },
      [&](const JointState& s) { return problem.cost(s); }, moved);
  JointResult result;
  result.T_camera_lidar = state.T_camera_lidar;
  result.T_camera_lidar.linear() =
      Eigen::Quaterniond(state.T_camera_lidar.linear()).normalized().toRotationMatrix();
  const Eigen::MatrixXd covariance =
      end.H.ldlt().solve(Eigen::MatrixXd::Identity(end.H.rows(), end.H.cols()));
  // Residuals: two a corner, seven and one a board, one offset. Parameters: seven, and seven a board.
  const double freedom = static_cast<double>(boards.size()) * (2.0 * board.corners() + 1) - 6;
  result.excess = std::sqrt(2 * end.cost / std::max(1.0, freedom));
  const double widen = std::max(1.0, result.excess * result.excess);
  result.covariance = widen * covariance.topLeftCorner<6, 6>();
  result.range_offset_m = state.range_offset_m;
  result.range_offset_sigma_m = std::sqrt(widen * covariance(6, 6));
  result.camera_noise_px = noise.camera_px;
  result.condition = scaled_condition(result.covariance, distance_m);
  return result;
}

Matrix6d board_information(const Chessboard& board, const Eigen::Isometry3d& T_camera_lidar,
                           const Eigen::Isometry3d& T_lidar_board, const LidarBoard::Information& information,
                           const PinholeIntrinsics& intrinsics, const JointNoise& noise) {
  Matrix6d mounting = Matrix6d::Zero();
  Eigen::Matrix<double, 6, 7> cross = Eigen::Matrix<double, 6, 7>::Zero();
  LidarBoard::Information own = with_angle_bias(information, T_lidar_board, noise.angle_bias_rad);
  own(6, 6) += 0.5 / (noise.range_bias_m * noise.range_bias_m);  // its own offset and that of all boards
  for (int k = 0; k < board.corners(); ++k) {
    const Projected p = project(board.corner(k), T_camera_lidar, T_lidar_board, intrinsics);
    const Jacobian2x6 Jm = p.by_mounting / noise.camera_px;
    const Jacobian2x6 Jb = p.by_board / noise.camera_px;
    mounting += Jm.transpose() * Jm;
    cross.leftCols<6>() += Jm.transpose() * Jb;
    own.topLeftCorner<6, 6>() += Jb.transpose() * Jb;
  }
  return mounting - cross * own.ldlt().solve(cross.transpose());
}

}  // namespace alight
