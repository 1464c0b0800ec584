#include "calibrate/stereo/stereo_bundle.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include "calibrate/fitting/levenberg_marquardt.hpp"
#include "calibrate/fitting/rigid_motion.hpp"

namespace alight {
namespace {

using Points = std::vector<cv::Point2d>;

Points project(const Chessboard& board, const Camera& camera, const Eigen::Isometry3d& T_camera_board) {
  std::vector<cv::Point3d> points;
  for (int i = 0; i < board.corners(); ++i) {
    const Eigen::Vector3d p = T_camera_board * board.corner(i);
    points.emplace_back(p.x(), p.y(), p.z());
  }
  Points pixels;
  const cv::Vec3d zero(0, 0, 0);
  if (camera.distortion_model == DistortionModel::kEquidistant) {
    cv::fisheye::projectPoints(points, pixels, zero, zero, camera.intrinsics.matrix(),
                               camera.distortion_coeffs);
  } else {
    cv::projectPoints(points, zero, zero, camera.intrinsics.matrix(), camera.distortion_coeffs, pixels);
  }
  return pixels;
}

Eigen::Index lens_parameters(const Camera& camera) {
  return 4 + static_cast<Eigen::Index>(camera.distortion_coeffs.size());
}

Camera moved(const Camera& camera, const Eigen::VectorXd& step) {
  Camera result = camera;
  result.intrinsics.fx_px += step[0];
  result.intrinsics.fy_px += step[1];
  result.intrinsics.cx_px += step[2];
  result.intrinsics.cy_px += step[3];
  for (std::size_t i = 0; i < camera.distortion_coeffs.size(); ++i)
    result.distortion_coeffs[i] += step[4 + static_cast<Eigen::Index>(i)];
  return result;
}

Eigen::Isometry3d turned(const Eigen::Isometry3d& T, const Vector6d& step) {
  Eigen::Isometry3d result = T;
  result.translation() += step.head<3>();
  result.linear() = rotation_exp(step.tail<3>()) * T.linear();
  return result;
}

Eigen::Index shared_parameters(const StereoBundle& s) {
  return lens_parameters(s.left) + lens_parameters(s.right) + 6;
}

StereoBundle moved(const StereoBundle& state, const Eigen::VectorXd& step) {
  StereoBundle result = state;
  const Eigen::Index left = lens_parameters(state.left);
  const Eigen::Index right = lens_parameters(state.right);
  result.left = moved(state.left, step.head(left));
  result.right = moved(state.right, step.segment(left, right));
  result.T_right_left = turned(state.T_right_left, step.segment<6>(left + right));
  for (std::size_t v = 0; v < state.T_left_board.size(); ++v)
    result.T_left_board[v] =
        turned(state.T_left_board[v], step.segment<6>(left + right + 6 + 6 * static_cast<Eigen::Index>(v)));
  return result;
}

/// Residuals of one view: left u v of each corner, then right.
Eigen::VectorXd residuals(const Chessboard& board, const StereoCorners& corners, const StereoBundle& s,
                          std::size_t view) {
  const int n = board.corners();
  Eigen::VectorXd r(4 * n);
  const Points left = project(board, s.left, s.T_left_board[view]);
  const Points right = project(board, s.right, s.T_right_left * s.T_left_board[view]);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    r[2 * i] = left[k].x - static_cast<double>((*corners.left)[k].x);
    r[2 * i + 1] = left[k].y - static_cast<double>((*corners.left)[k].y);
    r[2 * n + 2 * i] = right[k].x - static_cast<double>((*corners.right)[k].x);
    r[2 * n + 2 * i + 1] = right[k].y - static_cast<double>((*corners.right)[k].y);
  }
  return r;
}

class BundleProblem {
 public:
  BundleProblem(const Chessboard& board, const std::vector<StereoCorners>& corners)
      : board_(board), corners_(corners) {}

  NormalEquations linearise(const StereoBundle& state) const {
    constexpr double kStep = 1e-6;
    const Eigen::Index shared = shared_parameters(state);
    const Eigen::Index size = shared + 6 * static_cast<Eigen::Index>(corners_.size());
    NormalEquations out{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), 0};
    for (std::size_t v = 0; v < corners_.size(); ++v) {
      const Eigen::Index own = shared + 6 * static_cast<Eigen::Index>(v);
      const Eigen::VectorXd r = residuals(board_, corners_[v], state, v);
      Eigen::MatrixXd J(r.size(), shared + 6);
      for (Eigen::Index k = 0; k < shared + 6; ++k) {
        Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
        step[k < shared ? k : own + k - shared] = kStep;
        J.col(k) = (residuals(board_, corners_[v], moved(state, step), v) -
                    residuals(board_, corners_[v], moved(state, -step), v)) /
                   (2 * kStep);
      }
      const Eigen::MatrixXd H = J.transpose() * J;
      const Eigen::VectorXd g = J.transpose() * r;
      out.H.topLeftCorner(shared, shared) += H.topLeftCorner(shared, shared);
      out.H.block(0, own, shared, 6) += H.topRightCorner(shared, 6);
      out.H.block(own, 0, 6, shared) += H.bottomLeftCorner(6, shared);
      out.H.block<6, 6>(own, own) += H.bottomRightCorner<6, 6>();
      out.g.head(shared) += g.head(shared);
      out.g.segment<6>(own) += g.tail<6>();
      out.cost += 0.5 * r.squaredNorm();
    }
    return out;
  }
  double cost(const StereoBundle& state) const {
    double sum = 0;
    for (std::size_t v = 0; v < corners_.size(); ++v)
      sum += residuals(board_, corners_[v], state, v).squaredNorm();
    return 0.5 * sum;
  }

 private:
  const Chessboard& board_;
  const std::vector<StereoCorners>& corners_;
};

}  // namespace

Corners project_board(const Chessboard& board, const Camera& camera,
                      const Eigen::Isometry3d& T_camera_board) {
  Corners corners;
  for (const cv::Point2d& p : project(board, camera, T_camera_board)) corners.emplace_back(p);
  return corners;
}

BundleResult refine_stereo(const Chessboard& board, const std::vector<StereoCorners>& corners,
                           const StereoBundle& start) {
  const BundleProblem problem(board, corners);
  BundleResult result;
  result.bundle = start;
  const NormalEquations end = minimise(
      result.bundle, [&](const StereoBundle& s) { return problem.linearise(s); },
      [&](const StereoBundle& s) { return problem.cost(s); },
      [](const StereoBundle& s, const Eigen::VectorXd& step) { return moved(s, step); });
  const int n = board.corners();
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const Eigen::VectorXd r = residuals(board, corners[v], result.bundle, v);
    result.errors.push_back({r.head(2 * n).squaredNorm(), r.tail(2 * n).squaredNorm()});
  }
  const double residual_count = 4.0 * n * static_cast<double>(corners.size());
  const double variance = 2 * end.cost / std::max(1.0, residual_count - static_cast<double>(end.H.rows()));
  const Eigen::MatrixXd covariance =
      end.H.ldlt().solve(Eigen::MatrixXd::Identity(end.H.rows(), shared_parameters(start)));
  result.sigma = (variance * covariance.topRows(shared_parameters(start)).diagonal()).cwiseMax(0).cwiseSqrt();
  return result;
}

}  // namespace alight
