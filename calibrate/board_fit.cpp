#include "calibrate/board_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Eigenvalues>
#include <opencv2/calib3d.hpp>

#include "calibrate/levenberg_marquardt.hpp"
#include "calibrate/rigid_motion.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;

constexpr double kReach_squares =
    0.75;  // how far beyond the outermost corners points are used: all of it is print
constexpr int kMinPoints = 400;
constexpr int kMaxPoints = 40000;  // more bring nothing that the calibration could still see

/// A beam that ended on the board.
struct Beam {
  Vector3d direction;  // unit
  double range_m;
  double level;
};

struct Plane {
  Vector3d normal = Vector3d::UnitX();  // unit
  double distance_m = 0;                // normal . p = distance

  double range(const Vector3d& direction) const { return distance_m / normal.dot(direction); }
};

std::vector<Beam> beams_of(const std::vector<LidarReturn>& points) {
  const std::size_t step = points.size() / kMaxPoints + 1;
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Vector3d p = points[i].p_lidar.cast<double>();
    beams.push_back({p.normalized(), p.norm(), static_cast<double>(points[i].reflectivity)});
  }
  return beams;
}

Plane plane_through(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a).normalized();
  return {normal, normal.dot(a)};
}

Plane least_squares_plane(const std::vector<Beam>& beams, const std::vector<char>& used) {
  Vector3d mean = Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (used[i] == 0) continue;
    mean += beams[i].direction * beams[i].range_m;
    ++count;
  }
  mean /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (used[i] == 0) continue;
    const Vector3d d = beams[i].direction * beams[i].range_m - mean;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Vector3d normal = solver.eigenvectors().col(0);
  return {normal, normal.dot(mean)};
}

/// RANSAC over triples in a fixed pseudo-random order, then least squares over the inliers, twice.
Plane ransac_plane(const std::vector<Beam>& beams, std::vector<char>& inliers) {
  constexpr int kTrials = 100;
  constexpr double kThreshold_m = 0.06;  // three times the noise of a Livox
  std::uint64_t state = 1;
  const auto random_beam = [&]() -> const Beam& {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return beams[static_cast<std::size_t>(state >> 33U) % beams.size()];
  };
  const auto mark = [&](const Plane& plane, std::vector<char>& out) {
    std::size_t count = 0;
    out.resize(beams.size());
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const bool near = std::abs(plane.range(beams[i].direction) - beams[i].range_m) < kThreshold_m;
      out[i] = near ? 1 : 0;
      count += near ? 1 : 0;
    }
    return count;
  };
  Plane best;
  std::size_t most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Beam& a = random_beam();
    const Beam& b = random_beam();
    const Beam& c = random_beam();
    const Plane plane =
        plane_through(a.direction * a.range_m, b.direction * b.range_m, c.direction * c.range_m);
    if (!plane.normal.allFinite()) continue;
    const std::size_t count = mark(plane, inliers);
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  for (int k = 0; k < 2 && most >= 3; ++k) {
    mark(best, inliers);
    best = least_squares_plane(beams, inliers);
  }
  mark(best, inliers);
  return best;
}

/// Rigid motion that carries the board's corners onto points (Umeyama without scale), and the scale left over.
Eigen::Isometry3d align_board(const Chessboard& board, const std::vector<Vector3d>& corners_lidar,
                              double& scale) {
  Eigen::Matrix3Xd from(3, board.corners());
  Eigen::Matrix3Xd to(3, board.corners());
  for (int i = 0; i < board.corners(); ++i) {
    from.col(i) = board.corner(i);
    to.col(i) = corners_lidar[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d with_scale = Eigen::umeyama(from, to, true);
  scale = with_scale.topLeftCorner<3, 3>().col(0).norm();
  Eigen::Isometry3d T;
  T.matrix() = Eigen::umeyama(from, to, false);
  return T;
}

/// What is fitted. The first seven of its coordinates are LidarBoard::information's.
struct PrintState {
  Eigen::Isometry3d T_lidar_board;
  double range_offset_m = 0;
  double black = 0;
  double white = 0;
  double blur_x_m = 0;
  double blur_y_m = 0;
};
constexpr int kParameters = 11;
using Step = Eigen::Matrix<double, kParameters, 1>;

PrintState moved(const PrintState& state, const Eigen::VectorXd& step) {
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

struct Predicted {
  double range_m;
  double level;
  bool on_print;
};

class PrintModel {
 public:
  PrintModel(const Chessboard& board, bool first_is_dark)
      : board_(board), sign_(first_is_dark ? -1.0 : 1.0) {}

  Predicted predict(const PrintState& state, const Vector3d& direction) const {
    const Eigen::Matrix3d R = state.T_lidar_board.linear();
    const Vector3d& t = state.T_lidar_board.translation();
    const double range_m = R.col(2).dot(t) / R.col(2).dot(direction);
    const Vector3d on_plane = direction * range_m - t;
    const double x = R.col(0).dot(on_plane) / board_.square_m;
    const double y = R.col(1).dot(on_plane) / board_.square_m;
    const double pattern = sign_ * blurred_stripes(x, board_.columns - 1, state.blur_x_m / board_.square_m) *
                           blurred_stripes(y, board_.rows - 1, state.blur_y_m / board_.square_m);
    const bool inside = x > -kReach_squares && y > -kReach_squares &&
                        x < board_.columns - 1 + kReach_squares && y < board_.rows - 1 + kReach_squares;
    return {range_m + state.range_offset_m,
            0.5 * (state.white + state.black) + 0.5 * (state.white - state.black) * pattern, inside};
  }

 private:
  const Chessboard& board_;
  double sign_;
};

/// Fits the print to beams, with noise levels that come out of the residuals.
class PrintFit {
 public:
  PrintFit(const std::vector<Beam>& beams, const Chessboard& board, bool dark)
      : beams_(beams), model_(board, dark) {}

  double range_noise_m = 0.02;
  double level_noise = 10;

  /// Keeps the beams that meet the print and lie near its plane.
  void select(const PrintState& state) {
    used_.clear();
    for (const Beam& beam : beams_) {
      const Predicted p = model_.predict(state, beam.direction);
      if (p.on_print && std::abs(p.range_m - beam.range_m) < std::max(4 * range_noise_m, 0.02))
        used_.push_back(&beam);
    }
  }
  void measure_noise(const PrintState& state) {
    double range = 0;
    double level = 0;
    for (const Beam* beam : used_) {
      const Predicted p = model_.predict(state, beam->direction);
      range += std::pow(p.range_m - beam->range_m, 2);
      level += std::pow(p.level - beam->level, 2);
    }
    const double count = std::max(1.0, static_cast<double>(used_.size()) - kParameters);
    range_noise_m = std::max(1e-4, std::sqrt(range / count));
    level_noise = std::max(0.3, std::sqrt(level / count));
  }
  NormalEquations minimise(PrintState& state) const {
    return alight::minimise(
        state, [&](const PrintState& s) { return linearise(s); },
        [&](const PrintState& s) { return cost(s); }, moved);
  }
  std::size_t used() const { return used_.size(); }

 private:
  double cost(const PrintState& state) const {
    double sum = 0;
    for (const Beam* beam : used_) {
      const Predicted p = model_.predict(state, beam->direction);
      sum += std::pow((p.range_m - beam->range_m) / range_noise_m, 2) +
             std::pow((p.level - beam->level) / level_noise, 2);
    }
    return 0.5 * sum;
  }

  NormalEquations linearise(const PrintState& state) const {
    Step step_size;
    step_size << 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-3, 1e-3, 1e-6, 1e-6;
    std::array<PrintState, kParameters> ahead;
    for (int k = 0; k < kParameters; ++k) {
      Step step = Step::Zero();
      step[k] = step_size[k];
      ahead[static_cast<std::size_t>(k)] = moved(state, step);
    }
    Eigen::Matrix<double, kParameters, kParameters> H =
        Eigen::Matrix<double, kParameters, kParameters>::Zero();
    Step g = Step::Zero();
    double sum = 0;
    for (const Beam* beam : used_) {
      const Predicted at = model_.predict(state, beam->direction);
      Step J_range;
      Step J_level;
      for (int k = 0; k < kParameters; ++k) {
        const Predicted p = model_.predict(ahead[static_cast<std::size_t>(k)], beam->direction);
        J_range[k] = (p.range_m - at.range_m) / (step_size[k] * range_noise_m);
        J_level[k] = (p.level - at.level) / (step_size[k] * level_noise);
      }
      const double r_range = (at.range_m - beam->range_m) / range_noise_m;
      const double r_level = (at.level - beam->level) / level_noise;
      H.noalias() += J_range * J_range.transpose() + J_level * J_level.transpose();
      g += J_range * r_range + J_level * r_level;
      sum += r_range * r_range + r_level * r_level;
    }
    return {H, g, 0.5 * sum};
  }

  const std::vector<Beam>& beams_;
  PrintModel model_;
  std::vector<const Beam*> used_;
};

/// Levels of the darker and the lighter half: their quartiles.
void start_levels(const std::vector<Beam>& beams, PrintState& state) {
  std::vector<double> levels;
  for (const Beam& beam : beams) levels.push_back(beam.level);
  std::sort(levels.begin(), levels.end());
  state.black = levels[levels.size() / 5];
  state.white = levels[levels.size() - 1 - levels.size() / 5];
}

LidarBoardFit fit(const std::vector<Beam>& beams, const Chessboard& board, bool dark, PrintState state) {
  constexpr int kRounds = 3;
  PrintFit print(beams, board, dark);
  NormalEquations end;
  for (int round = 0; round < kRounds; ++round) {
    print.select(state);
    if (print.used() < kMinPoints)
      return {std::nullopt, "only " + std::to_string(print.used()) + " LiDAR points on the board"};
    print.measure_noise(state);
    end = print.minimise(state);
  }
  LidarBoard result;
  result.T_lidar_board = state.T_lidar_board;
  result.range_offset_m = state.range_offset_m;
  // Levels and blur are of no use to anyone else: marginalised out.
  const Eigen::Matrix<double, 4, 4> nuisance = end.H.bottomRightCorner<4, 4>();
  const Eigen::Matrix<double, 7, 4> shared = end.H.topRightCorner<7, 4>();
  result.information = end.H.topLeftCorner<7, 7>() - shared * nuisance.ldlt().solve(shared.transpose());
  print.measure_noise(state);
  result.range_noise_m = print.range_noise_m;
  result.reflectivity_noise = print.level_noise;
  result.blur_x_m = state.blur_x_m;
  result.blur_y_m = state.blur_y_m;
  result.black_level = state.black;
  result.white_level = state.white;
  result.points = static_cast<int>(print.used());
  return {result, ""};
}

std::string wrong_size(double measured_m, const Chessboard& board) {
  char text[160];
  std::snprintf(text, sizeof(text),
                "the LiDAR measures squares of %.4f m, not %.4f m: check --square-m with a ruler", measured_m,
                board.square_m);
  return text;
}

std::string judge(const LidarBoard& fitted, const Chessboard& board) {
  const double contrast = fitted.white_level - fitted.black_level;
  if (contrast < 4 * fitted.reflectivity_noise / std::sqrt(static_cast<double>(fitted.points)) ||
      contrast < 5) {
    return "the LiDAR sees the squares hardly apart (" + std::to_string(std::lround(contrast)) +
           " levels): print with carbon toner, dye inks are transparent to infrared light";
  }
  if (std::max(fitted.blur_x_m, fitted.blur_y_m) > 0.45 * board.square_m)
    return "the beam is nearly as wide as a square: come nearer or print larger squares";
  return "";
}

}  // namespace

std::vector<LidarReturn> points_on_board(const std::vector<LidarReturn>& points, const LidarImage& image,
                                         const Chessboard& board, const Corners& corners) {
  std::vector<cv::Point2f> grid;
  for (int i = 0; i < board.corners(); ++i)
    grid.emplace_back(static_cast<float>(i % board.columns), static_cast<float>(i / board.columns));
  const cv::Matx33d H = cv::findHomography(corners, grid);
  std::vector<LidarReturn> result;
  for (const LidarReturn& point : points) {
    if (point.p_lidar.x() <= 0) continue;
    const Eigen::Vector2d pixel = image.project(point.p_lidar.cast<double>());
    const cv::Vec3d h = H * cv::Vec3d(pixel.x(), pixel.y(), 1);
    const double x = h[0] / h[2];
    const double y = h[1] / h[2];
    // A little more than the fit uses: it decides by its own, better pose.
    if (x > -1 && y > -1 && x < board.columns && y < board.rows) result.push_back(point);
  }
  return result;
}

LidarBoardFit fit_lidar_board(const std::vector<LidarReturn>& on_board, const LidarImage& image,
                              const Chessboard& board, const Corners& corners, bool dark) {
  const std::vector<Beam> beams = beams_of(on_board);
  if (beams.size() < kMinPoints)
    return {std::nullopt, "only " + std::to_string(beams.size()) + " LiDAR points on the board"};
  std::vector<char> inliers;
  const Plane plane = ransac_plane(beams, inliers);
  const auto on_plane = std::count(inliers.begin(), inliers.end(), 1);
  if (static_cast<double>(on_plane) < 0.7 * static_cast<double>(beams.size()))
    return {std::nullopt,
            "the LiDAR points on the board lie on no plane: it is bent, or something stands in front of it"};
  std::vector<Vector3d> corners_lidar;
  for (const cv::Point2f& corner : corners) {
    const Vector3d ray = image.ray(corner);
    corners_lidar.emplace_back(ray * plane.range(ray));
  }
  PrintState state;
  double scale = 1;
  state.T_lidar_board = align_board(board, corners_lidar, scale);
  start_levels(beams, state);
  state.blur_x_m = state.blur_y_m = 0.1 * board.square_m;
  // Far boards are drawn coarsely; the fit decides more sharply.
  constexpr double kMaxStartScale = 0.12;
  constexpr double kMaxScale = 0.03;
  if (std::abs(scale - 1) > kMaxStartScale) return {std::nullopt, wrong_size(scale * board.square_m, board)};
  LidarBoardFit result = fit(beams, board, dark, state);
  if (!result.board) return result;
  const double distance_m = (result.board->T_lidar_board * board.centre()).norm();
  result.board->measured_square_m = board.square_m * (1 + result.board->range_offset_m / distance_m);
  if (std::abs(result.board->measured_square_m / board.square_m - 1) > kMaxScale)
    return {std::nullopt, wrong_size(result.board->measured_square_m, board)};
  if (const std::string reason = judge(*result.board, board); !reason.empty()) return {std::nullopt, reason};
  return result;
}

LidarBoardFit refit_lidar_board(const std::vector<LidarReturn>& on_board, const Chessboard& board, bool dark,
                                const LidarBoard& start) {
  const std::vector<Beam> beams = beams_of(on_board);
  if (beams.size() < kMinPoints)
    return {std::nullopt, "only " + std::to_string(beams.size()) + " LiDAR points on the board"};
  return fit(beams, board, dark,
             {start.T_lidar_board, start.range_offset_m, start.black_level, start.white_level, start.blur_x_m,
              start.blur_y_m});
}

}  // namespace alight
