#include "calibrate/lidar/board_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include "calibrate/board/board_plane.hpp"
#include "calibrate/lidar/print_fit.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;

constexpr int kMinPoints = 400;
constexpr const char* kNotFixed =
    "the LiDAR points do not fix where the board stands: record longer, with the board nearer";

/// Rigid motion that carries the board's corners onto points (Umeyama without scale), and the scale left over.
Eigen::Isometry3d align_board(const Chessboard& board, const std::vector<Vector3d>& corners_lidar,
                              double& scale) {
  Eigen::Matrix3Xd from(3, board.corners());
  Eigen::Matrix3Xd to(3, board.corners());
  for (int i = 0; i < board.corners(); ++i) {
    from.col(i) = board.corner(i);
    to.col(i) = corners_lidar[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d with_scale = Eigen::umeyama(from, to, true);
  scale = with_scale.topLeftCorner<3, 3>().col(0).norm();
  Eigen::Isometry3d T;
  T.matrix() = Eigen::umeyama(from, to, false);
  return T;
}

/// Levels of the darker and the lighter half: their quartiles.
void start_levels(const std::vector<Beam>& beams, PrintState& state) {
  std::vector<double> levels;
  for (const Beam& beam : beams) levels.push_back(beam.level);
  std::sort(levels.begin(), levels.end());
  state.black = levels[levels.size() / 5];
  state.white = levels[levels.size() - 1 - levels.size() / 5];
}

LidarBoardFit fit(const std::vector<Beam>& beams, const Chessboard& board, bool dark, PrintState state) {
  constexpr int kRounds = 3;
  PrintFit print(beams, board, dark);
  for (int round = 0; round < kRounds; ++round) {
    print.select(state);
    if (print.used() < kMinPoints)
      return {std::nullopt, "only " + std::to_string(print.used()) + " LiDAR points on the board"};
    print.measure_noise(state);
    if (!print.refine(state)) return {std::nullopt, kNotFixed};
  }
  const std::optional<LidarBoard::Covariance> covariance = print.covariance(state);
  if (!covariance) return {std::nullopt, kNotFixed};
  LidarBoard result;
  result.T_lidar_board = state.T_lidar_board;
  result.range_offset_m = state.range_offset_m;
  result.covariance = *covariance;
  print.measure_noise(state);
  result.range_noise_m = print.range_noise_m();
  result.reflectivity_noise = print.level_noise();
  result.blur_x_m = state.blur_x_m;
  result.blur_y_m = state.blur_y_m;
  result.black_level = state.black;
  result.white_level = state.white;
  result.points = static_cast<int>(print.used());
  return {result, ""};
}

std::string wrong_size(double measured_m, const Chessboard& board) {
  return fmt::format("the LiDAR measures squares of {:.4f} m, not {:.4f} m: check --square-m with a ruler",
                     measured_m, board.square_m);
}

std::string judge(const LidarBoard& fitted, const Chessboard& board) {
  const double contrast = fitted.white_level - fitted.black_level;
  if (contrast < 4 * fitted.reflectivity_noise / std::sqrt(static_cast<double>(fitted.points)) ||
      contrast < 5) {
    return "the LiDAR sees the squares hardly apart (" + std::to_string(std::lround(contrast)) +
           " levels): print with carbon toner, dye inks are transparent to infrared light";
  }
  if (std::max(fitted.blur_x_m, fitted.blur_y_m) > 0.45 * board.square_m)
    return "the beam is nearly as wide as a square: come nearer or print larger squares";
  return "";
}

}  // namespace

std::vector<LidarReturn> points_on_board(const std::vector<LidarReturn>& points, const LidarImage& image,
                                         const Chessboard& board, const Corners& corners) {
  std::vector<cv::Point2f> grid;
  for (int i = 0; i < board.corners(); ++i)
    grid.emplace_back(static_cast<float>(i % board.columns), static_cast<float>(i / board.columns));
  const cv::Matx33d H = cv::findHomography(corners, grid);
  std::vector<LidarReturn> result;
  for (const LidarReturn& point : points) {
    if (point.p_lidar.x() <= 0) continue;
    const Eigen::Vector2d pixel = image.project(point.p_lidar.cast<double>());
    const cv::Vec3d h = H * cv::Vec3d(pixel.x(), pixel.y(), 1);
    const double x = h[0] / h[2];
    const double y = h[1] / h[2];
    // A little more than the fit uses: it decides by its own, better pose.
    if (x > -1 && y > -1 && x < board.columns && y < board.rows) result.push_back(point);
  }
  return result;
}

LidarBoardFit fit_lidar_board(const std::vector<LidarReturn>& on_board, const LidarImage& image,
                              const Chessboard& board, const Corners& corners, bool dark) {
  const std::vector<Beam> beams = beams_of(on_board);
  if (beams.size() < kMinPoints)
    return {std::nullopt, "only " + std::to_string(beams.size()) + " LiDAR points on the board"};
  std::vector<char> inliers;
  const Plane plane = ransac_plane(beams, inliers);
  const auto on_plane = std::count(inliers.begin(), inliers.end(), 1);
  if (static_cast<double>(on_plane) < 0.7 * static_cast<double>(beams.size()))
    return {std::nullopt,
            "the LiDAR points on the board lie on no plane: it is bent, or something stands in front of it"};
  std::vector<Vector3d> corners_lidar;
  for (const cv::Point2f& corner : corners) {
    const Vector3d ray = image.ray(corner);
    corners_lidar.emplace_back(ray * plane.range(ray));
  }
  PrintState state;
  double scale = 1;
  state.T_lidar_board = align_board(board, corners_lidar, scale);
  start_levels(beams, state);
  state.blur_x_m = state.blur_y_m = 0.1 * board.square_m;
  // Far boards are drawn coarsely; the fit decides more sharply.
  constexpr double kMaxStartScale = 0.12;
  constexpr double kMaxScale = 0.03;
  if (std::abs(scale - 1) > kMaxStartScale) return {std::nullopt, wrong_size(scale * board.square_m, board)};
  LidarBoardFit result = fit(beams, board, dark, state);
  if (!result.board) return result;
  const double distance_m = (result.board->T_lidar_board * board.centre()).norm();
  result.board->measured_square_m = board.square_m * (1 + result.board->range_offset_m / distance_m);
  if (std::abs(result.board->measured_square_m / board.square_m - 1) > kMaxScale)
    return {std::nullopt, wrong_size(result.board->measured_square_m, board)};
  if (const std::string reason = judge(*result.board, board); !reason.empty()) return {std::nullopt, reason};
  return result;
}

LidarBoardFit refit_lidar_board(const std::vector<LidarReturn>& on_board, const Chessboard& board, bool dark,
                                const LidarBoard& start) {
  const std::vector<Beam> beams = beams_of(on_board);
  if (beams.size() < kMinPoints)
    return {std::nullopt, "only " + std::to_string(beams.size()) + " LiDAR points on the board"};
  return fit(beams, board, dark,
             {start.T_lidar_board, start.range_offset_m, start.black_level, start.white_level, start.blur_x_m,
              start.blur_y_m});
}

}  // namespace alight
