#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "calibrate/board/chessboard.hpp"
#include "calibrate/lidar/lidar_image.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// Where a board stands in the LiDAR's frame, from all points on it at once.
struct LidarBoard {
  using Covariance = Eigen::Matrix<double, 7, 7>;

  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  /// How much farther than the truth the LiDAR measures, metres: the print's size gives the true distance.
  double range_offset_m = 0;
  /// Of (translation [m], rotation vector [rad], both in the board's frame, range offset [m]). The offset and the
  /// distance lean on each other; with the offset known the distance is sharp.
  Covariance covariance = Covariance::Zero();
  double range_noise_m = 0;       ///< 1 sigma of the points about the plane, along their rays
  double reflectivity_noise = 0;  ///< 1 sigma about the model, levels
  double blur_x_m = 0;  ///< 1 sigma of the printed edges' blur (the beam's footprint) along the board's axes
  double blur_y_m = 0;
  double black_level = 0;
  double white_level = 0;
  double measured_square_m = 0;  ///< side of a square by the LiDAR's ranges alone
  int points = 0;
};

/// The result, or why there is none.
struct LidarBoardFit {
  std::optional<LidarBoard> board;
  std::string reason;
};

/// The points that fall on the squares of a board whose corners were found in the LiDAR's image.
std::vector<LidarReturn> points_on_board(const std::vector<LidarReturn>& points, const LidarImage& image,
                                         const Chessboard& board, const Corners& corners);

/// Paper 3.1: the board's plane by RANSAC, the rays of the image's corners meet it; then, beyond the paper, the print
/// is fitted to the reflectivity of every point. A point's place on the board comes from its beam's direction and the
/// plane, not from its noisy range; the edges between squares are as wide as the beam.
/// @param on_board of points_on_board. @param dark whether the first square is
LidarBoardFit fit_lidar_board(const std::vector<LidarReturn>& on_board, const LidarImage& image,
                              const Chessboard& board, const Corners& corners, bool dark);

/// The same from a start near the result, such as for a part of the points.
LidarBoardFit refit_lidar_board(const std::vector<LidarReturn>& on_board, const Chessboard& board, bool dark,
                                const LidarBoard& start);

}  // namespace alight
