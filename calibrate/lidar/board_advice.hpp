#pragma once

#include <vector>

#include "calibrate/lidar/extrinsics.hpp"

namespace alight {

/// Which board poses would narrow the covariance most, best first, of a grid over image, distance and tilt.
std::vector<Advice> advise_poses(const Chessboard& board, const std::vector<BoardView>& views,
                                 const Extrinsics& extrinsics, const PinholeIntrinsics& intrinsics,
                                 const ExtrinsicsConfig& config);

}  // namespace alight
