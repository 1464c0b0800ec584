#pragma once

#include <vector>

#include "calibrate/stereo/stereo_calibration.hpp"

namespace alight {

/// Finds the board in both images of every view, in parallel; views without it get a reason. The right camera's corners
/// come in the left one's order. @throws DataError naming a view of another resolution
void find_boards(const Chessboard& board, std::vector<StereoView>& views, int threads);

}  // namespace alight
