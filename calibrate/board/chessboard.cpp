#include "calibrate/board/chessboard.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kMaxRefinement_px = 2.5;

double smallest_spacing_px(const Chessboard& board, const Corners& corners) {
  double smallest = 1e9;
  for (int i = 0; i < board.corners(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i % board.columns != 0) smallest = std::min(smallest, cv::norm(corners[at] - corners[at - 1]));
    const auto row = static_cast<std::size_t>(board.columns);
    if (i >= board.columns) smallest = std::min(smallest, cv::norm(corners[at] - corners[at - row]));
  }
  return smallest;
}

/// x cross y points into the board, away from the viewer; a mirrored order is turned round row by row.
void remove_mirroring(const Chessboard& board, Corners& corners) {
  const cv::Point2f x = corners[static_cast<std::size_t>(board.columns - 1)] - corners[0];
  const cv::Point2f y = corners[static_cast<std::size_t>(board.columns * (board.rows - 1))] - corners[0];
  if (x.cross(y) > 0) return;
  for (int row = 0; row < board.rows; ++row) {
    const auto begin = corners.begin() + row * board.columns;
    std::reverse(begin, begin + board.columns);
  }
}

std::optional<Corners> detect(const cv::Mat& image, const Chessboard& board) {
  Corners corners;
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY;
  if (cv::findChessboardCornersSB(image, board.size(), corners, flags)) return corners;
  return std::nullopt;
}

/// Small boards are found once they are enlarged.
std::optional<Corners> detect_enlarged(const cv::Mat& image, const Chessboard& board) {
  constexpr double kScale = 2;
  cv::Mat large;
  cv::resize(image, large, {}, kScale, kScale, cv::INTER_CUBIC);
  std::optional<Corners> corners = detect(large, board);
  if (!corners) return std::nullopt;
  for (cv::Point2f& corner : *corners) {
    corner.x = (corner.x + 0.5F) / static_cast<float>(kScale) - 0.5F;
    corner.y = (corner.y + 0.5F) / static_cast<float>(kScale) - 0.5F;
  }
  return corners;
}

/// OpenCV's older detector finds some boards that the newer one does not; without the fast check it may search for
/// minutes where there is none.
std::optional<Corners> detect_classic(const cv::Mat& image, const Chessboard& board) {
  Corners corners;
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_FAST_CHECK;
  if (cv::findChessboardCorners(image, board.size(), corners, flags)) return corners;
  return std::nullopt;
}

}  // namespace

std::vector<cv::Point3f> Chessboard::corner_points() const {
  std::vector<cv::Point3f> points;
  for (int i = 0; i < corners(); ++i) {
    const Eigen::Vector3f p = corner(i).cast<float>();
    points.emplace_back(p.x(), p.y(), p.z());
  }
  return points;
}

std::string Chessboard::name() const { return std::to_string(columns) + "x" + std::to_string(rows); }

Chessboard parse_chessboard(const std::string& size, double square_m) {
  Chessboard board;
  board.square_m = square_m;
  char rest = 0;
  if (std::sscanf(size.c_str(), "%dx%d%c", &board.columns, &board.rows, &rest) != 2 || board.columns < 3 ||
      board.rows < 3 || board.columns > 50 || board.rows > 50) {
    throw ConfigError("--board " + size + ": expected the number of inner corners, as 9x6 (3 to 50 each)");
  }
  if (!(square_m > 0.001 && square_m < 10))
    throw ConfigError("--square-m: expected the side of a square in metres");
  return board;
}

std::optional<Corners> find_chessboard(const cv::Mat& image, const Chessboard& board) {
  std::optional<Corners> corners = detect(image, board);
  if (!corners) corners = detect_classic(image, board);
  if (!corners) corners = detect_enlarged(image, board);
  if (!corners) return std::nullopt;
  // A stain or reflection next to a corner may draw it away; such a corner keeps the detector's place.
  const Corners detected = *corners;
  refine_corners(image, board, *corners);
  for (std::size_t i = 0; i < detected.size(); ++i) {
    if (cv::norm((*corners)[i] - detected[i]) > kMaxRefinement_px) (*corners)[i] = detected[i];
  }
  remove_mirroring(board, *corners);
  return corners;
}

void refine_corners(const cv::Mat& image, const Chessboard& board, Corners& corners) {
  const int half = std::clamp(static_cast<int>(0.4 * smallest_spacing_px(board, corners)), 2, 11);
  cv::cornerSubPix(image, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4});
}

bool first_square_is_dark(const cv::Mat& image, const Chessboard& board, const Corners& corners) {
  double sum = 0;  // of the squares like the first, minus that of the others
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int column = 0; column + 1 < board.columns; ++column) {
      const auto at = static_cast<std::size_t>(row * board.columns + column);
      const auto below = at + static_cast<std::size_t>(board.columns);
      const cv::Point2f centre = (corners[at] + corners[at + 1] + corners[below] + corners[below + 1]) * 0.25;
      const int u = std::clamp(static_cast<int>(std::lround(centre.x)), 0, image.cols - 1);
      const int v = std::clamp(static_cast<int>(std::lround(centre.y)), 0, image.rows - 1);
      sum += ((row + column) % 2 == 0 ? 1.0 : -1.0) * image.at<std::uint8_t>(v, u);
    }
  }
  // An odd number of squares leaves one of the first kind over: its mean brightness is taken out.
  const int squares = (board.rows - 1) * (board.columns - 1);
  if (squares % 2 == 0) return sum < 0;
  double mean = 0;
  for (const cv::Point2f& corner : corners) {
    const int u = std::clamp(static_cast<int>(std::lround(corner.x)), 0, image.cols - 1);
    const int v = std::clamp(static_cast<int>(std::lround(corner.y)), 0, image.rows - 1);
    mean += image.at<std::uint8_t>(v, u) / static_cast<double>(corners.size());
  }
  return sum - mean < 0;
}

std::vector<Eigen::Isometry3d> board_turns(const Chessboard& board) {
  const int turns = board.columns == board.rows ? 4 : 2;
  std::vector<Eigen::Isometry3d> result;
  for (int k = 0; k < turns; ++k) {
    Eigen::Isometry3d T(Eigen::Translation3d(board.centre()));
    T.rotate(Eigen::AngleAxisd(to_radians(360.0 * k / turns), Eigen::Vector3d::UnitZ()));
    result.push_back(T * Eigen::Translation3d(-board.centre()));
  }
  return result;
}

std::string why_not_found(const cv::Mat& image, const Chessboard& board) {
  const std::string wanted = "no chessboard of " + board.name() + " inner corners found";
  Chessboard squares = board;  // who counts squares asks for one too many each way
  --squares.columns;
  --squares.rows;
  if (squares.columns >= 3 && squares.rows >= 3 && detect(image, squares)) {
    return wanted + ", but a grid of " + squares.name() +
           ": count again, --board takes the inner corners, one less than squares each way";
  }
  return wanted +
         "; the whole board with its white margin has to be in view, in even light, and --board counts the "
         "inner corners, not the squares";
}

}  // namespace alight
