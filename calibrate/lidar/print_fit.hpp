#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "calibrate/board/board_plane.hpp"
#include "calibrate/board/chessboard.hpp"
#include "calibrate/lidar/board_fit.hpp"

namespace ceres {
class Problem;
}

namespace alight {

/// What of a print is fitted.
struct PrintState {
  Eigen::Isometry3d T_lidar_board;
  double range_offset_m = 0;
  double black = 0;  ///< level of the ink
  double white = 0;
  double blur_x_m = 0;  ///< 1 sigma of the edges between squares
  double blur_y_m = 0;
};

/// Fits a chessboard's reflectivity (two levels, edges blurred by the beam's width) and its plane to beams, with noise
/// levels that come out of the residuals. Board and beams must outlive it.
class PrintFit {
 public:
  PrintFit(const std::vector<Beam>& beams, const Chessboard& board, bool first_is_dark)
      : beams_(beams), board_(board), first_is_dark_(first_is_dark) {}

  /// Keeps the beams that meet the print and lie near its plane.
  void select(const PrintState& state);
  void measure_noise(const PrintState& state);
  /// Moves `state` to the minimum. @returns false where there is none
  bool refine(PrintState& state) const;
  /// At a minimum. @returns empty where the beams leave a direction free
  std::optional<LidarBoard::Covariance> covariance(const PrintState& minimum) const;

  std::size_t used() const { return used_.size(); }
  double range_noise_m() const { return range_noise_m_; }
  double level_noise() const { return level_noise_; }

 private:
  struct Parameters;
  void add_residuals(Parameters& parameters, ceres::Problem& problem) const;

  const std::vector<Beam>& beams_;
  const Chessboard& board_;
  bool first_is_dark_;
  std::vector<const Beam*> used_;
  double range_noise_m_ = 0.02;
  double level_noise_ = 10;
};

}  // namespace alight
