#include "calibrate/lidar/extrinsics_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <opencv2/calib3d.hpp>

#include "calibrate/fitting/opencv_pose.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<cv::Point2d> to_points(const std::vector<Vector2d>& pixels) {
  std::vector<cv::Point2d> points;
  for (const Vector2d& pixel : pixels) points.emplace_back(pixel.x(), pixel.y());
  return points;
}

/// Where the camera alone sees a board: a plane has two poses that look nearly alike from afar.
std::vector<Eigen::Isometry3d> board_poses(const Chessboard& board, const BoardView& view,
                                           const PinholeIntrinsics& intrinsics) {
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::solvePnPGeneric(board.corner_points(), to_points(view.pixels), intrinsics.matrix(), cv::noArray(),
                      rotations, translations, false, cv::SOLVEPNP_IPPE);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    cv::solvePnPRefineLM(board.corner_points(), to_points(view.pixels), intrinsics.matrix(), cv::noArray(),
                         rotations[i], translations[i]);
    const Eigen::Isometry3d T = isometry_of(rotations[i], translations[i]);
    if (T.matrix().allFinite() && (T * board.centre()).z() > 0) poses.push_back(T);
  }
  return poses;
}

/// Sum of squared reprojection errors of corners, in pixels.
double squared_error(const Chessboard& board, const BoardView& view, const Eigen::Isometry3d& T_camera_board,
                     const PinholeIntrinsics& intrinsics) {
  double sum = 0;
  for (int i = 0; i < board.corners(); ++i) {
    const Vector3d p = T_camera_board * board.corner(i);
    if (p.z() <= 0.01) return std::numeric_limits<double>::infinity();
    sum += (intrinsics.project(p) - view.pixels[static_cast<std::size_t>(i)]).squaredNorm();
  }
  return sum;
}

}  // namespace

bool ExtrinsicsSearch::possible(const BoardView& view, std::size_t turn) const {
  // A turn by 180 deg swaps the squares' colours where rows + columns is odd; one by 90 deg where they are even too.
  bool swaps = false;
  if (turns_.size() == 2) {
    swaps = turn == 1 && (board_.rows + board_.columns) % 2 != 0;
  } else {
    swaps = turn % 2 == 1 && board_.rows % 2 != 0;
  }
  return (view.camera_first_dark == view.lidar_first_dark) != swaps;
}

std::vector<Eigen::Isometry3d> ExtrinsicsSearch::candidates() const {
  std::vector<Eigen::Isometry3d> result;
  for (const BoardView& view : views_) {
    for (const Eigen::Isometry3d& T_camera_board : board_poses(board_, view, intrinsics_)) {
      for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
        if (possible(view, turn))
          result.push_back(T_camera_board * (view.lidar.T_lidar_board * turns_[turn]).inverse());
      }
    }
  }
  return result;
}

Assignment ExtrinsicsSearch::assign(const Eigen::Isometry3d& T_camera_lidar, double truncate_px) const {
  Assignment result;
  for (const BoardView& view : views_) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t best_turn = 0;
    for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
      if (!possible(view, turn)) continue;
      const double error =
          squared_error(board_, view, T_camera_lidar * view.lidar.T_lidar_board * turns_[turn], intrinsics_);
      if (error >= best) continue;
      best = error;
      best_turn = turn;
    }
    result.turn.push_back(best_turn);
    result.rmse_px.push_back(std::sqrt(best / board_.corners()));
    result.score += std::min(best / board_.corners(), truncate_px * truncate_px);
  }
  return result;
}

/// Corners against the board's plane where the camera alone puts it, all boards together.
double ExtrinsicsSearch::camera_noise_px() const {
  double sum = 0;
  double freedom = 0;
  for (const BoardView& view : views_) {
    double best = std::numeric_limits<double>::infinity();
    for (const Eigen::Isometry3d& T : board_poses(board_, view, intrinsics_))
      best = std::min(best, squared_error(board_, view, T, intrinsics_));
    if (!std::isfinite(best)) continue;
    sum += best;
    freedom += 2.0 * board_.corners() - 6;
  }
  return std::max(config_.min_camera_noise_px, std::sqrt(sum / std::max(1.0, freedom)));
}

JointResult ExtrinsicsSearch::refine(const Eigen::Isometry3d& start, const Assignment& assignment,
                                     const std::vector<char>& used) const {
  std::vector<JointBoard> boards;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (used[i] == 0) continue;
    boards.push_back({&views_[i], turns_[assignment.turn[i]]});
  }
  // A LiDAR's direction error changes smoothly, so that boards near each other share it: many boards average it no
  // further than the three coefficients of its linear part over the field of view do.
  constexpr double kIndependentRegions = 3;
  const double shared = std::sqrt(std::max(1.0, static_cast<double>(boards.size()) / kIndependentRegions));
  return refine_jointly(
      board_, boards, intrinsics_,
      {camera_noise_px(), config_.range_bias_m, shared * to_radians(config_.angle_bias_deg)}, start);
}

/// The minima that the best candidates lead to, best first.
std::vector<ExtrinsicsSearch::Minimum> ExtrinsicsSearch::minima(const std::vector<char>& used) const {
  constexpr double kTruncate_px = 40;
  constexpr std::size_t kRestarts = 6;
  std::map<std::vector<std::size_t>, std::pair<double, Eigen::Isometry3d>> starts;  // by assignment
  for (const Eigen::Isometry3d& T : candidates()) {
    const Assignment assignment = assign(T, kTruncate_px);
    const auto known = starts.find(assignment.turn);
    if (known == starts.end() || assignment.score < known->second.first)
      starts.insert_or_assign(assignment.turn, std::make_pair(assignment.score, T));
  }
  std::vector<std::pair<double, Eigen::Isometry3d>> ranked;
  for (const auto& [turn, start] : starts) ranked.push_back(start);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  ranked.resize(std::min(ranked.size(), kRestarts));
  std::vector<Minimum> result;
  for (const auto& [score, start] : ranked) {
    const JointResult joint = refine(start, assign(start, kTruncate_px), used);
    result.push_back({joint, assign(joint.T_camera_lidar, kTruncate_px)});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.assignment.score < b.assignment.score; });
  return result;
}

}  // namespace alight
