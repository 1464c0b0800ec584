#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/errors.hpp"

namespace alight {

/// A printed chessboard. Frame `board`: origin at the first inner corner, x along the columns, y along the rows, z into
/// the board (OpenCV's convention). Corner number row * columns + column.
struct Chessboard {
  int columns = 0;  ///< inner corners along x
  int rows = 0;     ///< and along y
  double square_m = 0;

  cv::Size size() const { return {columns, rows}; }
  int corners() const { return columns * rows; }
  Eigen::Vector3d corner(int index) const {
    return {square_m * (index % columns), square_m * (index / columns), 0.0};
  }
  Eigen::Vector3d centre() const { return 0.5 * corner(corners() - 1); }
  std::vector<cv::Point3f> corner_points() const;
  /// "9x6"
  std::string name() const;
};

/// "9x6" (inner corners) and the side of a square. @throws ConfigError
Chessboard parse_chessboard(const std::string& size, double square_m);

using Corners = std::vector<cv::Point2f>;

/// The board's inner corners to sub-pixel precision in an order that is a turn, never a mirror image, of the board's.
/// @param image CV_8UC1. @returns empty: not found whole
std::optional<Corners> find_chessboard(const cv::Mat& image, const Chessboard& board);

/// Moves corners to the saddle points next to them (cv::cornerSubPix with a window that fits the squares).
void refine_corners(const cv::Mat& image, const Chessboard& board, Corners& corners);

/// Whether the square that touches corners 0, 1 and `columns` from inside is darker than its neighbours.
bool first_square_is_dark(const cv::Mat& image, const Chessboard& board, const Corners& corners);

/// The turns that map the grid of corners to itself: two, or four where columns = rows. Maps a corner in the turned
/// order's frame to the original frame.
std::vector<Eigen::Isometry3d> board_turns(const Chessboard& board);

/// What to tell a user whose board was not found: tries what is often confused.
std::string why_not_found(const cv::Mat& image, const Chessboard& board);

}  // namespace alight
