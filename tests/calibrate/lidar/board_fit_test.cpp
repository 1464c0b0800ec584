#include "calibrate/lidar/board_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "calibrate/fitting/rigid_motion.hpp"

namespace alight {
namespace {

constexpr double kRangeOffset_m = 0.004;
const Chessboard kPrint{6, 4, 0.12};

/// 4 m in front of a LiDAR that looks along x, tilted.
Eigen::Isometry3d board_pose() {
  Eigen::Isometry3d T(Eigen::Translation3d(4, 0.2, 0.1));
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 0).normalized()));
  return T * Eigen::Translation3d(-kPrint.centre());
}

/// Levels 20 and 120, the first square dark.
double level_at(double x_m, double y_m, double blur_m) {
  const auto stripes = [&](double x, int lines) {
    double value = 1;
    for (int line = 0; line < lines; ++line) {
      const double off = x - line * kPrint.square_m;
      value *= blur_m > 0 ? std::erf(off / (blur_m * std::sqrt(2.0))) : (off < 0 ? -1.0 : 1.0);
    }
    return value * (lines % 2 == 0 ? 1 : -1);
  };
  return 70 - 50 * stripes(x_m, kPrint.columns) * stripes(y_m, kPrint.rows);
}

/// Noiseless beams all over the print, each at a place of its own.
std::vector<LidarReturn> returns(double blur_m) {
  std::vector<LidarReturn> result;
  for (int i = 0; i < 20000; ++i) {
    const double x = kPrint.square_m * (-0.9 + (kPrint.columns + 0.8) * std::fmod(i * 0.7548776662466927, 1));
    const double y = kPrint.square_m * (-0.9 + (kPrint.rows + 0.8) * std::fmod(i * 0.5698402909980532, 1));
    const Eigen::Vector3d p = board_pose() * Eigen::Vector3d(x, y, 0);
    LidarReturn point;
    point.p_lidar = (p * (1 + kRangeOffset_m / p.norm())).cast<float>();
    point.reflectivity = static_cast<std::uint8_t>(std::lround(level_at(x, y, blur_m)));
    result.push_back(point);
  }
  return result;
}

LidarBoard start() {
  LidarBoard start;
  Vector6d off;
  off << 0.006, -0.005, 0.01, 0.01, -0.01, 0.005;
  start.T_lidar_board = board_pose() * small_motion(off);
  start.black_level = 30;
  start.white_level = 110;
  start.blur_x_m = start.blur_y_m = 0.012;
  return start;
}

/// How far the fit is off: (translation, rotation) in the board's frame, range offset.
Eigen::Matrix<double, 7, 1> error_of(const LidarBoard& fitted) {
  Eigen::Matrix<double, 7, 1> error;
  error << motion_vector(board_pose().inverse() * fitted.T_lidar_board),
      fitted.range_offset_m - kRangeOffset_m;
  return error;
}

TEST(BoardFit, FindsABlurredPrintWithinWhatItSaysOfItsError) {
  const LidarBoardFit fit = refit_lidar_board(returns(0.01), kPrint, true, start());
  ASSERT_TRUE(fit.board) << fit.reason;
  const auto error = error_of(*fit.board);
  const auto sigma = fit.board->covariance.diagonal().cwiseSqrt().eval();
  for (int i = 0; i < 7; ++i) EXPECT_LT(std::abs(error[i]), 4 * sigma[i]) << i;
  EXPECT_LT(sigma.head<2>().maxCoeff(), 1e-4);
  EXPECT_NEAR(fit.board->blur_x_m, 0.01, 2e-4);
  EXPECT_NEAR(fit.board->blur_y_m, 0.01, 2e-4);
  EXPECT_NEAR(fit.board->black_level, 20, 0.5);
  EXPECT_NEAR(fit.board->white_level, 120, 0.5);
}

TEST(BoardFit, FindsAPrintThatBeamsOfNoWidthSeeSharp) {
  const LidarBoardFit fit = refit_lidar_board(returns(0), kPrint, true, start());
  ASSERT_TRUE(fit.board) << fit.reason;
  EXPECT_LT(error_of(*fit.board).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(fit.board->blur_x_m, 1e-3);
  EXPECT_TRUE(fit.board->covariance.allFinite());
}

}  // namespace
}  // namespace alight
