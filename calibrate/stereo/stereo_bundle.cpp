#include "calibrate/stereo/stereo_bundle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <opencv2/calib3d.hpp>

#include "calibrate/fitting/least_squares.hpp"
#include "calibrate/fitting/pose_block.hpp"
#include "foundation/errors.hpp"

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

/// Squared reprojection errors, summed.
double squared_error(const Points& projected, const Corners& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += std::pow(cv::norm(projected[i] - cv::Point2d(corners[i])), 2);
  return sum;
}

/// fx fy cx cy, then the distortion's coefficients; those that a lens does not have stay zero.
using LensBlock = std::array<double, 9>;

LensBlock lens_block(const Camera& camera) {
  const PinholeIntrinsics& k = camera.intrinsics;
  LensBlock block{k.fx_px, k.fy_px, k.cx_px, k.cy_px};
  std::copy(camera.distortion_coeffs.begin(), camera.distortion_coeffs.end(), block.begin() + 4);
  return block;
}

Camera with_lens(Camera camera, const LensBlock& block) {
  PinholeIntrinsics& k = camera.intrinsics;
  std::tie(k.fx_px, k.fy_px, k.cx_px, k.cy_px) = std::tie(block[0], block[1], block[2], block[3]);
  std::copy_n(block.begin() + 4, camera.distortion_coeffs.size(), camera.distortion_coeffs.begin());
  return camera;
}

/// cv::projectPoints' model at z = 1. D: k1 k2 p1 p2 k3
template <class T>
Eigen::Matrix<T, 2, 1> distort_radtan(const T& x, const T& y, const T* D) {
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (D[0] + r2 * (D[1] + r2 * D[4]));
  return {x * radial + 2.0 * D[2] * x * y + D[3] * (r2 + 2.0 * x * x),
          y * radial + D[2] * (r2 + 2.0 * y * y) + 2.0 * D[3] * x * y};
}

/// cv::fisheye::projectPoints' model at z = 1. D: k1 k2 k3 k4
template <class T>
Eigen::Matrix<T, 2, 1> distort_equidistant(const T& x, const T& y, const T* D) {
  using std::atan;
  using std::sqrt;
  const T r2 = x * x + y * y;
  if (r2 < 1e-16) return {x, y};
  const T r = sqrt(r2);
  const T theta = atan(r);
  const T t2 = theta * theta;
  const T scale = theta * (1.0 + t2 * (D[0] + t2 * (D[1] + t2 * (D[2] + t2 * D[3])))) / r;
  return {x * scale, y * scale};
}

/// Reprojection error of a corner in pixels.
struct StereoCornerResidual {
  Eigen::Vector3d p_board;
  Eigen::Vector2d pixel;
  DistortionModel model;

  template <class T>
  bool operator()(const T* lens, const T* T_left_board, T* residual) const {
    return reproject<T>(lens, PoseView<T>(T_left_board) * p_board.cast<T>(), residual);
  }
  template <class T>
  bool operator()(const T* lens, const T* T_right_left, const T* T_left_board, T* residual) const {
    return reproject<T>(lens, PoseView<T>(T_right_left) * (PoseView<T>(T_left_board) * p_board.cast<T>()),
                        residual);
  }

 private:
  template <class T>
  bool reproject(const T* lens, const Eigen::Matrix<T, 3, 1>& p, T* residual) const {
    const T x = p.x() / p.z();
    const T y = p.y() / p.z();
    const Eigen::Matrix<T, 2, 1> distorted = model == DistortionModel::kEquidistant
                                                 ? distort_equidistant(x, y, lens + 4)
                                                 : distort_radtan(x, y, lens + 4);
    residual[0] = lens[0] * distorted.x() + lens[2] - pixel.x();
    residual[1] = lens[1] * distorted.y() + lens[3] - pixel.y();
    return true;
  }
};

/// All of a bundle as parameter blocks.
class BundleProblem {
 public:
  BundleProblem(const Chessboard& board, const std::vector<StereoCorners>& corners, const StereoBundle& start)
      : board_(board),
        left_(lens_block(start.left)),
        right_(lens_block(start.right)),
        T_right_left_(pose_block(start.T_right_left)) {
    add_lens(start.left, left_);
    add_lens(start.right, right_);
    problem_.AddParameterBlock(T_right_left_.data(), 7, new PoseManifold);
    T_left_board_.reserve(corners.size());
    for (std::size_t v = 0; v < corners.size(); ++v) {
      T_left_board_.push_back(pose_block(start.T_left_board[v]));
      add_view(corners[v], start, T_left_board_.back());
    }
  }

  std::optional<double> minimise() { return alight::minimise(problem_); }
  /// Of the lenses and the right camera's place; empty where the views leave a direction free.
  std::optional<Eigen::MatrixXd> covariance() {
    return alight::covariance(problem_, {left_.data(), right_.data(), T_right_left_.data()});
  }
  /// Residuals less parameters.
  double freedom() const {
    int parameters = 0;
    std::vector<double*> blocks;
    problem_.GetParameterBlocks(&blocks);
    for (const double* block : blocks) parameters += problem_.ParameterBlockTangentSize(block);
    return problem_.NumResiduals() - parameters;
  }
  StereoBundle bundle(const StereoBundle& start) const {
    StereoBundle result{
        with_lens(start.left, left_), with_lens(start.right, right_), transform_of(T_right_left_), {}};
    for (const PoseBlock& pose : T_left_board_) result.T_left_board.push_back(transform_of(pose));
    return result;
  }

 private:
  void add_lens(const Camera& camera, LensBlock& block) {
    std::vector<int> constant;
    for (std::size_t i = 4 + camera.distortion_coeffs.size(); i < block.size(); ++i)
      constant.push_back(static_cast<int>(i));
    problem_.AddParameterBlock(block.data(), static_cast<int>(block.size()),
                               new ceres::SubsetManifold(static_cast<int>(block.size()), constant));
  }
  void add_view(const StereoCorners& corners, const StereoBundle& start, PoseBlock& T_left_board) {
    problem_.AddParameterBlock(T_left_board.data(), 7, new PoseManifold);
    const auto residual = [&](const Camera& camera, const Corners& seen, int i) {
      const cv::Point2d pixel = seen[static_cast<std::size_t>(i)];
      return new StereoCornerResidual{board_.corner(i), {pixel.x, pixel.y}, camera.distortion_model};
    };
    for (int i = 0; i < board_.corners(); ++i) {
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<StereoCornerResidual, 2, 9, 7>(
                                    residual(start.left, *corners.left, i)),
                                nullptr, left_.data(), T_left_board.data());
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<StereoCornerResidual, 2, 9, 7, 7>(
                                    residual(start.right, *corners.right, i)),
                                nullptr, right_.data(), T_right_left_.data(), T_left_board.data());
    }
  }

  const Chessboard& board_;
  LensBlock left_;
  LensBlock right_;
  PoseBlock T_right_left_;
  std::vector<PoseBlock> T_left_board_;  // of which the problem holds pointers
  ceres::Problem problem_;
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
  BundleProblem problem(board, corners, start);
  const std::optional<double> cost = problem.minimise();
  const std::optional<Eigen::MatrixXd> covariance = cost ? problem.covariance() : std::nullopt;
  if (!covariance) {
    throw DataError(
        "the views do not fix the cameras: record the board tilted to all sides, near and far, and in every "
        "corner of the image");
  }
  BundleResult result;
  result.bundle = problem.bundle(start);
  const StereoBundle& found = result.bundle;
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const Eigen::Isometry3d& T = found.T_left_board[v];
    result.errors.push_back(
        {squared_error(project(board, found.left, T), *corners[v].left),
         squared_error(project(board, found.right, found.T_right_left * T), *corners[v].right)});
  }
  const double variance = 2 * *cost / std::max(1.0, problem.freedom());
  result.sigma = (variance * covariance->diagonal()).cwiseSqrt();
  return result;
}

}  // namespace alight
