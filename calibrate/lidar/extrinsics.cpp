#include "calibrate/lidar/extrinsics.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibrate/lidar/extrinsics_search.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

double tilt_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return to_degrees(std::acos(std::clamp(std::abs(a.normalized().dot(b.normalized())), 0.0, 1.0)));
}

void require_spread(const std::vector<BoardView>& views, const std::vector<char>& used,
                    const ExtrinsicsConfig& config) {
  double widest_deg = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (used[i] == 0 || used[k] == 0) continue;
      widest_deg = std::max(widest_deg, tilt_deg(views[i].lidar.T_lidar_board.linear().col(2),
                                                 views[k].lidar.T_lidar_board.linear().col(2)));
    }
  }
  if (widest_deg >= config.min_tilt_spread_deg) return;
  throw DataError(fmt::format(
      "boards all parallel (within {:.1f} deg, at least {:.0f} are needed): the extrinsics are not well "
      "observable - turns about axes in the board's plane (yaw and pitch) cannot be told from shifts; record "
      "more boards, tilted by 20 to 40 deg to the left, right, front and back",
      widest_deg, config.min_tilt_spread_deg));
}

void require_observable(const Extrinsics& result, const ExtrinsicsConfig& config) {
  static const char* const kAxesInWords[] = {"x (right)", "y (down)", "z (forward)"};
  const Vector6d sigma = result.sigma();
  int shift = 0;
  int turn = 0;
  sigma.head<3>().maxCoeff(&shift);
  sigma.tail<3>().maxCoeff(&turn);
  const double turn_deg = to_degrees(sigma[3 + turn]);
  if (sigma[shift] <= config.max_translation_sigma_m && turn_deg <= config.max_rotation_sigma_deg) return;
  throw DataError(fmt::format(
      "the extrinsics are not observable well enough: 1 sigma of the shift along the camera's {} is "
      "{:.1f} mm (at most {:.1f}), of the turn about its {} {:.3f} deg (at most {:.3f}); record "
      "more boards, at other places of the image, nearer, and tilted in other directions",
      kAxesInWords[shift], 1e3 * sigma[shift], 1e3 * config.max_translation_sigma_m, kAxesInWords[turn],
      turn_deg, config.max_rotation_sigma_deg));
}

void require_distinct(const Extrinsics& result, const ExtrinsicsConfig& config) {
  if (result.alternatives.empty()) return;
  const Alternative& other = result.alternatives.front();
  if (other.rmse_px >= config.min_distinctness * std::max(result.rmse_px, 0.2)) return;
  throw DataError(fmt::format(
      "two extrinsics explain the boards: RMSE {:.2f} px and {:.2f} px; {:.0f} deg apart. The board's two "
      "ends look alike and all boards are at nearly one place: record boards farther apart in the image, or "
      "use a board whose numbers of corners are one even and one odd",
      result.rmse_px, other.rmse_px,
      to_degrees(
          rotation_log(result.T_camera_lidar.linear().transpose() * other.T_camera_lidar.linear()).norm())));
}

int count(const std::vector<char>& used) { return static_cast<int>(std::count(used.begin(), used.end(), 1)); }

void require_enough(const std::vector<char>& used, const ExtrinsicsConfig& config) {
  if (count(used) >= config.min_boards) return;
  throw DataError("only " + std::to_string(count(used)) + " boards are usable, " +
                  std::to_string(config.min_boards) +
                  " are needed (10 or more are good); record more of them");
}

/// Boards that do not fit are left out one by one, the worst first. @returns the minima of the others, best first
std::vector<ExtrinsicsSearch::Minimum> search_without_outliers(const ExtrinsicsSearch& search,
                                                               const ExtrinsicsConfig& config,
                                                               std::vector<char>& used) {
  require_enough(used, config);
  std::vector<ExtrinsicsSearch::Minimum> found = search.minima(used);
  if (found.empty())
    throw DataError("no extrinsics explain even one board; is it the same board for both sensors?");
  for (;;) {
    const Assignment& assignment = found.front().assignment;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] != 0 && (used[worst] == 0 || assignment.rmse_px[i] > assignment.rmse_px[worst])) worst = i;
    }
    if (assignment.rmse_px[worst] <= config.max_board_rmse_px) return found;
    used[worst] = 0;
    require_enough(used, config);
    found = search.minima(used);
    found.front().assignment = search.assign(found.front().joint.T_camera_lidar, config.max_board_rmse_px);
  }
}

BoardResult board_result(const Chessboard& board, const BoardView& view,
                         const Eigen::Isometry3d& T_camera_lidar, double rmse_px, bool used,
                         const ExtrinsicsConfig& config) {
  const Eigen::Isometry3d T_camera_board = T_camera_lidar * view.lidar.T_lidar_board;
  const Eigen::Vector3d centre = T_camera_board * board.centre();
  BoardResult result{view.name, rmse_px, centre.norm(), tilt_deg(T_camera_board.linear().col(2), centre),
                     used,      ""};
  if (used) return result;
  result.reason =
      fmt::format("its corners are {:.1f} px off (limit {:.1f}): it moved, or a wrong board was found",
                  rmse_px, config.max_board_rmse_px);
  return result;
}

double rmse_of_used(const Assignment& assignment, const std::vector<char>& used) {
  double squares = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
    squares += used[i] != 0 ? std::pow(assignment.rmse_px[i], 2) : 0.0;
  return std::sqrt(squares / count(used));
}

/// Of the minima behind the first, those that are other extrinsics; best first.
std::vector<Alternative> alternatives(const std::vector<ExtrinsicsSearch::Minimum>& found,
                                      const std::vector<char>& used) {
  constexpr double kSame_deg = 2;
  constexpr double kSame_m = 0.1;
  std::vector<Alternative> result;
  for (std::size_t k = 1; k < found.size(); ++k) {
    const Eigen::Isometry3d apart =
        found.front().joint.T_camera_lidar.inverse() * found[k].joint.T_camera_lidar;
    if (to_degrees(rotation_log(apart.linear()).norm()) < kSame_deg && apart.translation().norm() < kSame_m)
      continue;
    result.push_back({found[k].joint.T_camera_lidar, rmse_of_used(found[k].assignment, used)});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Alternative& a, const Alternative& b) { return a.rmse_px < b.rmse_px; });
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
  b.field("min_distinctness", c.min_distinctness, "RMSE of the second best extrinsics over that of the best",
          at_least(1));
  b.field("range_bias_m", c.range_bias_m, "1 sigma of the LiDAR's systematic range error", positive());
  b.field("angle_bias_deg", c.angle_bias_deg, "1 sigma of its systematic direction error at a board",
          positive());
  b.field("min_camera_noise_px", c.min_camera_noise_px, "1 sigma: no corner is better known", positive());
}

Extrinsics solve_extrinsics(const Chessboard& board, const std::vector<BoardView>& views,
                            const PinholeIntrinsics& intrinsics, const ExtrinsicsConfig& config) {
  const ExtrinsicsSearch search(board, views, intrinsics, config);
  std::vector<char> used(views.size(), 1);
  const std::vector<ExtrinsicsSearch::Minimum> found = search_without_outliers(search, config, used);
  require_spread(views, used, config);
  const JointResult& joint = found.front().joint;
  Extrinsics result;
  result.T_camera_lidar = joint.T_camera_lidar;
  result.covariance = joint.covariance;
  result.camera_noise_px = joint.camera_noise_px;
  result.excess = joint.excess;
  result.range_offset_m = joint.range_offset_m;
  result.range_offset_sigma_m = joint.range_offset_sigma_m;
  result.condition = joint.condition;
  for (std::size_t i = 0; i < views.size(); ++i) {
    result.boards.push_back(board_result(board, views[i], joint.T_camera_lidar,
                                         found.front().assignment.rmse_px[i], used[i] != 0, config));
  }
  result.rmse_px = rmse_of_used(found.front().assignment, used);
  result.alternatives = alternatives(found, used);
  require_distinct(result, config);
  require_observable(result, config);
  return result;
}

}  // namespace alight
