#include "calibrate/lidar/print_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>

#include "calibrate/fitting/least_squares.hpp"
#include "calibrate/fitting/pose_block.hpp"

namespace alight {

/// A PrintState as parameter blocks.
struct PrintFit::Parameters {
  PoseBlock pose;
  double range_offset_m;
  std::array<double, 4> look;  ///< black, white, blur along x and y [m]

  explicit Parameters(const PrintState& state)
      : pose(pose_block(state.T_lidar_board)),
        range_offset_m(state.range_offset_m),
        look{state.black, state.white, state.blur_x_m, state.blur_y_m} {}
};

namespace {

using Eigen::Vector3d;

constexpr double kReach_squares =
    0.75;  // how far beyond the outermost corners points are used: all of it is print
constexpr double kLeastBlur_m = 1e-4;
constexpr int kParameters = 11;

double value_of(double x) { return x; }
template <class T, int N>
T value_of(const ceres::Jet<T, N>& x) {
  return x.a;
}

/// +1 and -1 in turn between the lines 0, 1, .. last, blurred by a normal of `blur` (all in squares); +1 between lines 0
/// and 1.
template <class T>
T blurred_stripes(const T& x, int last, const T& blur) {
  using std::erf;
  const double line = std::clamp(std::round(value_of(x)), 0.0, static_cast<double>(last));
  const double sign = static_cast<int>(line) % 2 == 0 ? 1.0 : -1.0;
  return sign * erf((x - line) / (blur * std::sqrt(2.0)));
}

/// What a beam should measure.
template <class T>
struct PredictedReturn {
  T range_m;
  T level;
  bool on_print;
};

/// A chessboard at one state. T: double or ceres::Jet
template <class T>
class Print {
 public:
  Print(const Chessboard& board, bool first_is_dark, const T* pose, const T& range_offset_m, const T* look)
      : board_(board),
        R_board_lidar_(PoseView<T>(pose).rotation.toRotationMatrix().transpose()),
        t_board_(R_board_lidar_ * PoseView<T>(pose).translation),
        range_offset_m_(range_offset_m),
        mean_(0.5 * (look[1] + look[0])),
        contrast_((first_is_dark ? -0.5 : 0.5) * (look[1] - look[0])) {
    using std::sqrt;
    for (std::size_t axis = 0; axis < 2; ++axis)
      blur_[axis] = sqrt(look[2 + axis] * look[2 + axis] + kLeastBlur_m * kLeastBlur_m) / board.square_m;
  }

  PredictedReturn<T> predict(const Vector3d& direction) const {
    const Eigen::Matrix<T, 3, 1> along = R_board_lidar_ * direction;
    const T range_m = t_board_.z() / along.z();
    const T x = (along.x() * range_m - t_board_.x()) / board_.square_m;
    const T y = (along.y() * range_m - t_board_.y()) / board_.square_m;
    const T pattern =
        blurred_stripes(x, board_.columns - 1, blur_[0]) * blurred_stripes(y, board_.rows - 1, blur_[1]);
    const bool inside = x > -kReach_squares && y > -kReach_squares &&
                        x < board_.columns - 1 + kReach_squares && y < board_.rows - 1 + kReach_squares;
    return {range_m + range_offset_m_, mean_ + contrast_ * pattern, inside};
  }

 private:
  const Chessboard& board_;
  Eigen::Matrix<T, 3, 3> R_board_lidar_;
  Eigen::Matrix<T, 3, 1> t_board_;  // from the LiDAR to the board's origin, along the board's axes
  T range_offset_m_;
  T mean_;
  T contrast_;
  std::array<T, 2> blur_;  // squares
};

/// Range and level of each beam over their noise.
struct PrintResiduals {
  const Chessboard& board;
  bool first_is_dark;
  const std::vector<const Beam*>& beams;
  double range_noise_m;
  double level_noise;

  template <class T>
  bool operator()(const T* pose, const T* range_offset_m, const T* look, T* residuals) const {
    const Print<T> print(board, first_is_dark, pose, *range_offset_m, look);
    for (const Beam* beam : beams) {
      const PredictedReturn<T> p = print.predict(beam->direction);
      *residuals++ = (p.range_m - beam->range_m) / range_noise_m;
      *residuals++ = (p.level - beam->level) / level_noise;
    }
    return true;
  }
};

Print<double> print_at(const Chessboard& board, bool first_is_dark, const PrintState& state) {
  const std::array<double, 4> look = {state.black, state.white, state.blur_x_m, state.blur_y_m};
  return {board, first_is_dark, pose_block(state.T_lidar_board).data(), state.range_offset_m, look.data()};
}

}  // namespace

void PrintFit::select(const PrintState& state) {
  const Print<double> print = print_at(board_, first_is_dark_, state);
  used_.clear();
  for (const Beam& beam : beams_) {
    const PredictedReturn<double> p = print.predict(beam.direction);
    if (p.on_print && std::abs(p.range_m - beam.range_m) < std::max(4 * range_noise_m_, 0.02))
      used_.push_back(&beam);
  }
}

void PrintFit::measure_noise(const PrintState& state) {
  const Print<double> print = print_at(board_, first_is_dark_, state);
  double range = 0;
  double level = 0;
  for (const Beam* beam : used_) {
    const PredictedReturn<double> p = print.predict(beam->direction);
    range += std::pow(p.range_m - beam->range_m, 2);
    level += std::pow(p.level - beam->level, 2);
  }
  const double count = std::max(1.0, static_cast<double>(used_.size()) - kParameters);
  range_noise_m_ = std::max(1e-4, std::sqrt(range / count));
  level_noise_ = std::max(0.3, std::sqrt(level / count));
}

void PrintFit::add_residuals(Parameters& parameters, ceres::Problem& problem) const {
  problem.AddParameterBlock(parameters.pose.data(), 7, new PoseManifold);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<PrintResiduals, ceres::DYNAMIC, 7, 1, 4>(
          new PrintResiduals{board_, first_is_dark_, used_, range_noise_m_, level_noise_},
          2 * static_cast<int>(used_.size())),
      nullptr, parameters.pose.data(), &parameters.range_offset_m, parameters.look.data());
}

bool PrintFit::refine(PrintState& state) const {
  Parameters parameters(state);
  ceres::Problem problem;
  add_residuals(parameters, problem);
  if (!minimise(problem)) return false;
  const auto& [black, white, blur_x_m, blur_y_m] = parameters.look;
  state = {transform_of(parameters.pose),
           parameters.range_offset_m,
           black,
           white,
           std::abs(blur_x_m),
           std::abs(blur_y_m)};
  return true;
}

std::optional<LidarBoard::Covariance> PrintFit::covariance(const PrintState& minimum) const {
  Parameters parameters(minimum);
  ceres::Problem problem;
  add_residuals(parameters, problem);
  const auto in_lidar = alight::covariance(problem, {parameters.pose.data(), &parameters.range_offset_m});
  if (!in_lidar) return std::nullopt;
  LidarBoard::Covariance turn = LidarBoard::Covariance::Identity();
  turn.topLeftCorner<3, 3>() = turn.block<3, 3>(3, 3) = minimum.T_lidar_board.linear().transpose();
  return turn * *in_lidar * turn.transpose();
}

}  // namespace alight
