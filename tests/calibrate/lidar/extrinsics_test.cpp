#include "calibrate/lidar/extrinsics.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

const PinholeIntrinsics kIntrinsics{440, 440, 319.5, 199.5, 640, 400};

Eigen::Isometry3d true_extrinsics() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T.translation() = Eigen::Vector3d(0.04, 0.09, -0.03);
  return T;
}

/// A board whose centre is at `centre` (camera), tilted about an axis of its plane.
BoardView view_of(const Chessboard& board, const Eigen::Vector3d& centre, double tilt_deg, double axis_deg) {
  const double axis = to_radians(axis_deg);
  Eigen::Isometry3d T_camera_board(Eigen::Translation3d{centre});
  T_camera_board.rotate(
      Eigen::AngleAxisd(to_radians(tilt_deg), Eigen::Vector3d(std::cos(axis), std::sin(axis), 0)));
  T_camera_board = T_camera_board * Eigen::Translation3d(-board.centre());
  BoardView view;
  view.name = "board";
  view.lidar.T_lidar_board = true_extrinsics().inverse() * T_camera_board;
  view.lidar.covariance = 1e-6 * LidarBoard::Covariance::Identity();
  view.lidar.covariance(6, 6) = 1e-4;
  for (int i = 0; i < board.corners(); ++i)
    view.pixels.push_back(kIntrinsics.project(T_camera_board * board.corner(i)));
  view.camera_first_dark = view.lidar_first_dark = true;
  return view;
}

std::vector<BoardView> spread_views(const Chessboard& board) {
  return {view_of(board, {-0.6, 0.1, 4}, 30, 0), view_of(board, {0.5, -0.3, 3.5}, 30, 90),
          view_of(board, {0.1, 0.4, 4.5}, 25, 200), view_of(board, {0.4, 0.3, 5}, 30, 300)};
}

std::string failure(const Chessboard& board, const std::vector<BoardView>& views,
                    const ExtrinsicsConfig& config) {
  try {
    solve_extrinsics(board, views, kIntrinsics, config);
  } catch (const DataError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

TEST(Extrinsics, OfPerfectBoardsAreFoundExactly) {
  const Chessboard board{6, 4, 0.12};
  const Extrinsics result = solve_extrinsics(board, spread_views(board), kIntrinsics, {});
  EXPECT_TRUE(result.T_camera_lidar.isApprox(true_extrinsics(), 1e-6));
  EXPECT_LT(result.rmse_px, 1e-3);
}

TEST(Extrinsics, SortOutBoardsThatTheLidarSeesTheOtherWayRound) {
  const Chessboard board{6, 4, 0.12};  // both ends alike
  std::vector<BoardView> views = spread_views(board);
  for (const std::size_t turned : {1u, 3u})
    views[turned].lidar.T_lidar_board = views[turned].lidar.T_lidar_board * board_turns(board)[1];
  EXPECT_TRUE(
      solve_extrinsics(board, views, kIntrinsics, {}).T_camera_lidar.isApprox(true_extrinsics(), 1e-6));
}

TEST(Extrinsics, LeaveOutABoardThatMoved) {
  const Chessboard board{6, 4, 0.12};
  std::vector<BoardView> views = spread_views(board);
  views[2].lidar.T_lidar_board.translation() += Eigen::Vector3d(0, 0.1, 0);
  const Extrinsics result = solve_extrinsics(board, views, kIntrinsics, {});
  EXPECT_TRUE(result.T_camera_lidar.isApprox(true_extrinsics(), 1e-6));
  EXPECT_FALSE(result.boards[2].used);
  EXPECT_THAT(result.boards[2].reason, HasSubstr("it moved"));
}

TEST(Extrinsics, RefuseTwoThatExplainTheBoardsEquallyWell) {
  // Ends alike, and all at one place: turned by half about the board's middle, every corner lies on a corner again.
  const Chessboard board{6, 4, 0.12};
  const std::vector<BoardView> views(3, view_of(board, {0.1, 0.1, 4}, 20, 0));
  ExtrinsicsConfig config;
  config.min_tilt_spread_deg = 0;
  const std::string message = failure(board, views, config);
  EXPECT_THAT(message, HasSubstr("two extrinsics explain the boards"));
  EXPECT_THAT(message, HasSubstr("180 deg apart"));
  EXPECT_THAT(message, HasSubstr("record boards farther apart in the image"));
}

TEST(Extrinsics, ABoardWithDifferentEndsIsNotAmbiguous) {
  const Chessboard board{6, 5, 0.12};
  const std::vector<BoardView> views(3, view_of(board, {0.1, 0.1, 4}, 20, 0));
  ExtrinsicsConfig config;
  config.min_tilt_spread_deg = 0;
  EXPECT_THAT(failure(board, views, config), ::testing::Not(HasSubstr("two extrinsics")));
}

TEST(Extrinsics, RefuseParallelBoards) {
  const Chessboard board{6, 4, 0.12};
  const std::vector<BoardView> views = {view_of(board, {-0.6, 0.1, 4}, 0, 0),
                                        view_of(board, {0.5, -0.3, 3.5}, 2, 0),
                                        view_of(board, {0.1, 0.4, 4.5}, 2, 90)};
  EXPECT_THAT(failure(board, views, {}), HasSubstr("boards all parallel"));
}

TEST(Extrinsics, RefuseTooFewBoards) {
  const Chessboard board{6, 4, 0.12};
  EXPECT_THAT(failure(board, {view_of(board, {0, 0, 4}, 20, 0)}, {}),
              HasSubstr("only 1 boards are usable, 3"));
}

TEST(Extrinsics, RefuseWhatIsHardlyObservable) {
  const Chessboard board{6, 4, 0.12};
  ExtrinsicsConfig config;
  config.max_translation_sigma_m = 1e-6;
  const std::string message = failure(board, spread_views(board), config);
  EXPECT_THAT(message, HasSubstr("not observable well enough"));
  EXPECT_THAT(message, HasSubstr("record more boards"));
}

}  // namespace
}  // namespace alight
