#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "calibrate/board/board_plane.hpp"
#include "calibrate/board/chessboard.hpp"
#include "calibrate/fitting/levenberg_marquardt.hpp"

namespace alight {

/// What of a print is fitted. The first seven of its coordinates (pose, range offset) are LidarBoard::information's.
struct PrintState {
  Eigen::Isometry3d T_lidar_board;
  double range_offset_m = 0;
  double black = 0;  ///< level of the ink
  double white = 0;
  double blur_x_m = 0;  ///< 1 sigma of the edges between squares
  double blur_y_m = 0;
};

/// What a beam should measure.
struct PredictedReturn {
  double range_m;
  double level;
  bool on_print;
};

/// A chessboard's reflectivity: two levels, edges blurred by the beam's width.
class PrintModel {
 public:
  /// The board must outlive the model.
  PrintModel(const Chessboard& board, bool first_is_dark)
      : board_(board), sign_(first_is_dark ? -1.0 : 1.0) {}

  PredictedReturn predict(const PrintState& state, const Eigen::Vector3d& direction) const;

 private:
  const Chessboard& board_;
  double sign_;
};

/// Fits the print to beams, with noise levels that come out of the residuals. Board and beams must outlive it.
class PrintFit {
 public:
  PrintFit(const std::vector<Beam>& beams, const Chessboard& board, bool first_is_dark)
      : beams_(beams), model_(board, first_is_dark) {}

  /// Keeps the beams that meet the print and lie near its plane.
  void select(const PrintState& state);
  void measure_noise(const PrintState& state);
  /// Moves `state` to the minimum. @returns the normal equations there, in the order of PrintState's fields
  NormalEquations minimise(PrintState& state) const;

  std::size_t used() const { return used_.size(); }
  double range_noise_m() const { return range_noise_m_; }
  double level_noise() const { return level_noise_; }

 private:
  double cost(const PrintState& state) const;
  NormalEquations linearise(const PrintState& state) const;

  const std::vector<Beam>& beams_;
  PrintModel model_;
  std::vector<const Beam*> used_;
  double range_noise_m_ = 0.02;
  double level_noise_ = 10;
};

}  // namespace alight
