#include "calibrate/extrinsics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "calibrate/joint_refinement.hpp"
#include "configs/errors.hpp"
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

Eigen::Isometry3d to_isometry(const cv::Mat& rotation, const cv::Mat& translation) {
  cv::Mat R;
  cv::Rodrigues(rotation, R);
  Eigen::Matrix3d R_eigen;
  cv::cv2eigen(R, R_eigen);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R_eigen;
  T.translation() = Vector3d(translation.at<double>(0), translation.at<double>(1), translation.at<double>(2));
  return T;
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
    const Eigen::Isometry3d T = to_isometry(rotations[i], translations[i]);
    if (T.matrix().allFinite() && (T * board.centre()).z() > 0) poses.push_back(T);
  }
  return poses;
}

/// Sum of squared reprojection errors of corners `turned` by a mounting, in pixels.
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

/// Which turn of its corners each board has, and how well it then fits.
struct Assignment {
  std::vector<std::size_t> turn;
  std::vector<double> rmse_px;
  double score = 0;  // sum of squares, each board's truncated
};

class Solver {
 public:
  Solver(const Chessboard& board, const std::vector<BoardView>& views, const PinholeIntrinsics& intrinsics,
         const ExtrinsicsConfig& config)
      : board_(board), views_(views), intrinsics_(intrinsics), config_(config), turns_(board_turns(board)) {}

  Extrinsics solve();

 private:
  bool possible(const BoardView& view, std::size_t turn) const {
    // A turn by 180 deg swaps the squares' colours where rows + columns is odd; one by 90 deg where they are even too.
    bool swaps = false;
    if (turns_.size() == 2) {
      swaps = turn == 1 && (board_.rows + board_.columns) % 2 != 0;
    } else {
      swaps = turn % 2 == 1 && board_.rows % 2 != 0;
    }
    return (view.camera_first_dark == view.lidar_first_dark) != swaps;
  }
  std::vector<Eigen::Isometry3d> candidates() const;
  Assignment assign(const Eigen::Isometry3d& T_camera_lidar, double truncate_px) const;
  double camera_noise_px() const;
  JointResult refine(const Eigen::Isometry3d& start, const Assignment& assignment,
                     const std::vector<char>& used) const;
  std::vector<std::pair<JointResult, Assignment>> minima(const std::vector<char>& used) const;
  void require_spread(const std::vector<char>& used) const;
  void require_observable(const Extrinsics& result) const;
  void require_distinct(const Extrinsics& result) const;

  const Chessboard& board_;
  const std::vector<BoardView>& views_;
  const PinholeIntrinsics& intrinsics_;
  const ExtrinsicsConfig& config_;
  std::vector<Eigen::Isometry3d> turns_;
};

std::vector<Eigen::Isometry3d> Solver::candidates() const {
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

Assignment Solver::assign(const Eigen::Isometry3d& T_camera_lidar, double truncate_px) const {
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
double Solver::camera_noise_px() const {
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

JointResult Solver::refine(const Eigen::Isometry3d& start, const Assignment& assignment,
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
std::vector<std::pair<JointResult, Assignment>> Solver::minima(const std::vector<char>& used) const {
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
  std::vector<std::pair<JointResult, Assignment>> result;
  for (const auto& [score, start] : ranked) {
    const JointResult joint = refine(start, assign(start, kTruncate_px), used);
    result.emplace_back(joint, assign(joint.T_camera_lidar, kTruncate_px));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.second.score < b.second.score; });
  return result;
}

double tilt_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return to_degrees(std::acos(std::clamp(std::abs(a.normalized().dot(b.normalized())), 0.0, 1.0)));
}

void Solver::require_spread(const std::vector<char>& used) const {
  double widest_deg = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (used[i] == 0 || used[k] == 0) continue;
      widest_deg = std::max(widest_deg, tilt_deg(views_[i].lidar.T_lidar_board.linear().col(2),
                                                 views_[k].lidar.T_lidar_board.linear().col(2)));
    }
  }
  if (widest_deg >= config_.min_tilt_spread_deg) return;
  char text[400];
  std::snprintf(
      text, sizeof(text),
      "boards all parallel (within %.1f deg, at least %.0f are needed): the mounting is not well observable "
      "- "
      "turns about axes in the board's plane (yaw and pitch) cannot be told from shifts; record more boards, "
      "tilted by 20 to 40 deg to the left, right, front and back",
      widest_deg, config_.min_tilt_spread_deg);
  throw DataError(text);
}

void Solver::require_observable(const Extrinsics& result) const {
  static const char* const kAxes[] = {"x (right)", "y (down)", "z (forward)"};
  const Vector6d sigma = result.sigma();
  int shift = 0;
  int turn = 0;
  sigma.head<3>().maxCoeff(&shift);
  sigma.tail<3>().maxCoeff(&turn);
  const double turn_deg = to_degrees(sigma[3 + turn]);
  if (sigma[shift] <= config_.max_translation_sigma_m && turn_deg <= config_.max_rotation_sigma_deg) return;
  char text[400];
  std::snprintf(
      text, sizeof(text),
      "the mounting is not observable well enough: 1 sigma of the shift along the camera's %s is %.1f mm (at "
      "most %.1f), of the turn about its %s %.3f deg (at most %.3f); record more boards, at other places of "
      "the image, nearer, and tilted in other directions",
      kAxes[shift], 1e3 * sigma[shift], 1e3 * config_.max_translation_sigma_m, kAxes[turn], turn_deg,
      config_.max_rotation_sigma_deg);
  throw DataError(text);
}

void Solver::require_distinct(const Extrinsics& result) const {
  if (result.alternatives.empty()) return;
  const Alternative& other = result.alternatives.front();
  if (other.rmse_px >= config_.min_distinctness * std::max(result.rmse_px, 0.2)) return;
  char text[400];
  std::snprintf(
      text, sizeof(text),
      "two mountings explain the boards: RMSE %.2f px and %.2f px; %.0f deg apart. The board's two ends look "
      "alike and all boards are at nearly one place: record boards farther apart in the image, or use a "
      "board "
      "whose numbers of corners are one even and one odd",
      result.rmse_px, other.rmse_px,
      to_degrees(
          rotation_log(result.T_camera_lidar.linear().transpose() * other.T_camera_lidar.linear()).norm()));
  throw DataError(text);
}

Extrinsics Solver::solve() {
  std::vector<char> used(views_.size(), 1);
  const auto count = [&] { return static_cast<int>(std::count(used.begin(), used.end(), 1)); };
  const auto require_enough = [&] {
    if (count() >= config_.min_boards) return;
    throw DataError("only " + std::to_string(count()) + " boards are usable, " +
                    std::to_string(config_.min_boards) +
                    " are needed (10 or more are good); record more of them");
  };
  require_enough();
  std::vector<std::pair<JointResult, Assignment>> found = minima(used);
  if (found.empty())
    throw DataError("no mounting explains even one board; is it the same board for both sensors?");
  // Boards that do not fit are left out one by one, the worst first.
  JointResult joint = found.front().first;
  Assignment assignment = found.front().second;
  for (;;) {
    std::size_t worst = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (used[i] != 0 && (used[worst] == 0 || assignment.rmse_px[i] > assignment.rmse_px[worst])) worst = i;
    }
    if (assignment.rmse_px[worst] <= config_.max_board_rmse_px) break;
    used[worst] = 0;
    require_enough();
    found = minima(used);
    joint = found.front().first;
    assignment = assign(joint.T_camera_lidar, config_.max_board_rmse_px);
  }
  require_spread(used);

  Extrinsics result;
  result.T_camera_lidar = joint.T_camera_lidar;
  result.covariance = joint.covariance;
  result.camera_noise_px = joint.camera_noise_px;
  result.excess = joint.excess;
  result.range_offset_m = joint.range_offset_m;
  result.range_offset_sigma_m = joint.range_offset_sigma_m;
  result.condition = joint.condition;
  double sum = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const Eigen::Isometry3d T_camera_board = joint.T_camera_lidar * views_[i].lidar.T_lidar_board;
    const Vector3d centre = T_camera_board * board_.centre();
    BoardResult board{views_[i].name, assignment.rmse_px[i],
                      centre.norm(),  tilt_deg(T_camera_board.linear().col(2), centre),
                      used[i] != 0,   ""};
    if (!board.used) {
      char text[200];
      std::snprintf(text, sizeof(text),
                    "its corners are %.1f px off (limit %.1f): it moved, or a wrong board was found",
                    board.rmse_px, config_.max_board_rmse_px);
      board.reason = text;
    }
    if (board.used) sum += board.rmse_px * board.rmse_px;
    result.boards.push_back(board);
  }
  result.rmse_px = std::sqrt(sum / count());
  for (std::size_t k = 1; k < found.size(); ++k) {
    const Eigen::Isometry3d apart = result.T_camera_lidar.inverse() * found[k].first.T_camera_lidar;
    if (to_degrees(rotation_log(apart.linear()).norm()) < 2 && apart.translation().norm() < 0.1) continue;
    double squares = 0;
    for (std::size_t i = 0; i < views_.size(); ++i)
      squares += used[i] != 0 ? std::pow(found[k].second.rmse_px[i], 2) : 0.0;
    result.alternatives.push_back({found[k].first.T_camera_lidar, std::sqrt(squares / count())});
  }
  std::stable_sort(result.alternatives.begin(), result.alternatives.end(),
                   [](const Alternative& a, const Alternative& b) { return a.rmse_px < b.rmse_px; });
  require_distinct(result);
  require_observable(result);
  return result;
}

}  // namespace

void bind(Binder& b, ExtrinsicsConfig& c) {
  b.field("max_board_rmse_px", c.max_board_rmse_px, "boards that fit worse are left out", positive());
  b.field("min_boards", c.min_boards, "that have to be usable", between(3, 1000));
  b.field("min_tilt_spread_deg", c.min_tilt_spread_deg, "between the two most different boards",
          between(0, 90));
  b.field("max_rotation_sigma_deg", c.max_rotation_sigma_deg, "a result that is less certain is refused",
          positive());
  b.field("max_translation_sigma_m", c.max_translation_sigma_m, "a result that is less certain is refused",
          positive());
  b.field("min_distinctness", c.min_distinctness, "RMSE of the second best mounting over that of the best",
          at_least(1));
  b.field("range_bias_m", c.range_bias_m, "1 sigma of the LiDAR's systematic range error", positive());
  b.field("angle_bias_deg", c.angle_bias_deg, "1 sigma of its systematic direction error at a board",
          positive());
  b.field("min_camera_noise_px", c.min_camera_noise_px, "1 sigma: no corner is better known", positive());
}

Extrinsics solve_extrinsics(const Chessboard& board, const std::vector<BoardView>& views,
                            const PinholeIntrinsics& intrinsics, const ExtrinsicsConfig& config) {
  return Solver(board, views, intrinsics, config).solve();
}

}  // namespace alight
