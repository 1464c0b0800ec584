#include "calibrate/lidar/print_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "calibrate/fitting/rigid_motion.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;

constexpr double kReach_squares =
    0.75;  // how far beyond the outermost corners points are used: all of it is print
constexpr int kParameters = 11;
using Step = Eigen::Matrix<double, kParameters, 1>;

PrintState moved_by(const PrintState& state, const Eigen::VectorXd& step) {
  PrintState result = state;
  result.T_lidar_board = state.T_lidar_board * small_motion(step.head<6>());
  result.range_offset_m += step[6];
  result.black += step[7];
  result.white += step[8];
  result.blur_x_m = std::max(1e-4, state.blur_x_m + step[9]);
  result.blur_y_m = std::max(1e-4, state.blur_y_m + step[10]);
  return result;
}

/// +1 and -1 in turn between the lines 0, 1, .. last, blurred by a normal of `blur` (all in squares); +1 between lines 0
/// and 1.
double blurred_stripes(double x, int last, double blur) {
  const double line = std::clamp(std::round(x), 0.0, static_cast<double>(last));
  const double sign = static_cast<int>(line) % 2 == 0 ? 1.0 : -1.0;
  return sign * std::erf((x - line) / (blur * std::sqrt(2.0)));
}

}  // namespace

PredictedReturn PrintModel::predict(const PrintState& state, const Vector3d& direction) const {
  const Eigen::Matrix3d R = state.T_lidar_board.linear();
  const Vector3d& t = state.T_lidar_board.translation();
  const double range_m = R.col(2).dot(t) / R.col(2).dot(direction);
  const Vector3d on_plane = direction * range_m - t;
  const double x = R.col(0).dot(on_plane) / board_.square_m;
  const double y = R.col(1).dot(on_plane) / board_.square_m;
  const double pattern = sign_ * blurred_stripes(x, board_.columns - 1, state.blur_x_m / board_.square_m) *
                         blurred_stripes(y, board_.rows - 1, state.blur_y_m / board_.square_m);
  const bool inside = x > -kReach_squares && y > -kReach_squares && x < board_.columns - 1 + kReach_squares &&
                      y < board_.rows - 1 + kReach_squares;
  return {range_m + state.range_offset_m,
          0.5 * (state.white + state.black) + 0.5 * (state.white - state.black) * pattern, inside};
}

void PrintFit::select(const PrintState& state) {
  used_.clear();
  for (const Beam& beam : beams_) {
    const PredictedReturn p = model_.predict(state, beam.direction);
    if (p.on_print && std::abs(p.range_m - beam.range_m) < std::max(4 * range_noise_m_, 0.02))
      used_.push_back(&beam);
  }
}

void PrintFit::measure_noise(const PrintState& state) {
  double range = 0;
  double level = 0;
  for (const Beam* beam : used_) {
    const PredictedReturn p = model_.predict(state, beam->direction);
    range += std::pow(p.range_m - beam->range_m, 2);
    level += std::pow(p.level - beam->level, 2);
  }
  const double count = std::max(1.0, static_cast<double>(used_.size()) - kParameters);
  range_noise_m_ = std::max(1e-4, std::sqrt(range / count));
  level_noise_ = std::max(0.3, std::sqrt(level / count));
}

NormalEquations PrintFit::minimise(PrintState& state) const {
  return alight::minimise(
      state, [&](const PrintState& s) { return linearise(s); }, [&](const PrintState& s) { return cost(s); },
      moved_by);
}

double PrintFit::cost(const PrintState& state) const {
  double sum = 0;
  for (const Beam* beam : used_) {
    const PredictedReturn p = model_.predict(state, beam->direction);
    sum += std::pow((p.range_m - beam->range_m) / range_noise_m_, 2) +
           std::pow((p.level - beam->level) / level_noise_, 2);
  }
  return 0.5 * sum;
}

NormalEquations PrintFit::linearise(const PrintState& state) const {
  Step step_size;
  step_size << 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-3, 1e-3, 1e-6, 1e-6;
  std::array<PrintState, kParameters> ahead;
  for (int k = 0; k < kParameters; ++k) {
    Step step = Step::Zero();
    step[k] = step_size[k];
    ahead[static_cast<std::size_t>(k)] = moved_by(state, step);
  }
  Eigen::Matrix<double, kParameters, kParameters> H = Eigen::Matrix<double, kParameters, kParameters>::Zero();
  Step g = Step::Zero();
  double sum = 0;
  for (const Beam* beam : used_) {
    const PredictedReturn at = model_.predict(state, beam->direction);
    Step J_range;
    Step J_level;
    for (int k = 0; k < kParameters; ++k) {
      const PredictedReturn p = model_.predict(ahead[static_cast<std::size_t>(k)], beam->direction);
      J_range[k] = (p.range_m - at.range_m) / (step_size[k] * range_noise_m_);
      J_level[k] = (p.level - at.level) / (step_size[k] * level_noise_);
    }
    const double r_range = (at.range_m - beam->range_m) / range_noise_m_;
    const double r_level = (at.level - beam->level) / level_noise_;
    H.noalias() += J_range * J_range.transpose() + J_level * J_level.transpose();
    g += J_range * r_range + J_level * r_level;
    sum += r_range * r_range + r_level * r_level;
  }
  return {H, g, 0.5 * sum};
}

}  // namespace alight
