#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "calibrate/lidar/extrinsics.hpp"
#include "calibrate/lidar/joint_refinement.hpp"

namespace alight {

/// Which turn of its corners each board has, and how well it then fits.
struct Assignment {
  std::vector<std::size_t> turn;  ///< index into board_turns
  std::vector<double> rmse_px;
  double score = 0;  ///< sum of squares, each board's truncated
};

/// Extrinsics that explain boards, found without a start value. Everything given must outlive the search.
class ExtrinsicsSearch {
 public:
  struct Minimum {
    JointResult joint;
    Assignment assignment;
  };

  ExtrinsicsSearch(const Chessboard& board, const std::vector<BoardView>& views,
                   const PinholeIntrinsics& intrinsics, const ExtrinsicsConfig& config)
      : board_(board), views_(views), intrinsics_(intrinsics), config_(config), turns_(board_turns(board)) {}

  /// The minima that the best candidates lead to, best first. @param used of each view, not 0 where it counts
  std::vector<Minimum> minima(const std::vector<char>& used) const;
  /// The best order of corners of each board for given extrinsics. @param truncate_px no board scores worse than this
  Assignment assign(const Eigen::Isometry3d& T_camera_lidar, double truncate_px) const;

 private:
  bool possible(const BoardView& view, std::size_t turn) const;
  std::vector<Eigen::Isometry3d> candidates() const;
  double camera_noise_px() const;
  JointResult refine(const Eigen::Isometry3d& start, const Assignment& assignment,
                     const std::vector<char>& used) const;

  const Chessboard& board_;
  const std::vector<BoardView>& views_;
  const PinholeIntrinsics& intrinsics_;
  const ExtrinsicsConfig& config_;
  std::vector<Eigen::Isometry3d> turns_;
};

}  // namespace alight
