#include "calibrate/stereo/stereo_views.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>

#include <fmt/format.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

/// The cameras hang upright beside each other, so that the board looks alike to both: the order of the right corners in
/// which they lie as the left ones do, but for a shift.
void match_order(const Chessboard& board, const Corners& left, Corners& right) {
  Corners best = right;
  double best_spread = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& turn : board_turns(board)) {
    Corners turned;
    cv::Point2d mean(0, 0);
    for (int i = 0; i < board.corners(); ++i) {
      const Eigen::Vector3d at = turn * board.corner(i) / board.square_m;
      const auto index = static_cast<std::size_t>(std::lround(at.y()) * board.columns + std::lround(at.x()));
      turned.push_back(right[index]);
      mean += cv::Point2d(right[index] - left[static_cast<std::size_t>(i)]) / board.corners();
    }
    double spread = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const cv::Point2d off = cv::Point2d(turned[i] - left[i]) - mean;
      spread += off.dot(off);
    }
    if (spread >= best_spread) continue;
    best_spread = spread;
    best = turned;
  }
  right = best;
}

void find_board(const Chessboard& board, StereoView& view) {
  const auto left = find_chessboard(view.left, board);
  const auto right = find_chessboard(view.right, board);
  if (!left || !right) {
    view.reason = (left    ? "right: "
                   : right ? "left: "
                           : "both cameras: ") +
                  why_not_found(left ? view.right : view.left, board);
    return;
  }
  view.left_corners = *left;
  view.right_corners = *right;
  match_order(board, view.left_corners, view.right_corners);
}

}  // namespace

void find_boards(const Chessboard& board, std::vector<StereoView>& views, int threads) {
  for (const StereoView& view : views) {
    for (const cv::Mat* image : {&view.left, &view.right}) {
      if (image->size() == views.front().left.size()) continue;
      throw DataError(view.name + ": the " + (image == &view.left ? "left" : "right") +
                      fmt::format(" image has {}x{} pixels, the first view's {}x{}; all have to be of one "
                                  "resolution, recorded as they will be used",
                                  image->cols, image->rows, views.front().left.cols,
                                  views.front().left.rows));
    }
  }
  const auto step = static_cast<std::size_t>(std::max(1, threads));
  for (std::size_t first = 0; first < views.size(); first += step) {
    std::vector<std::future<void>> running;
    for (std::size_t i = first; i < std::min(first + step, views.size()); ++i)
      running.push_back(std::async(std::launch::async, [&board, &views, i] { find_board(board, views[i]); }));
    for (std::future<void>& search : running) search.get();
  }
}

}  // namespace alight
