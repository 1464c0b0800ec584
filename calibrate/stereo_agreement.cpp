#include "calibrate/stereo_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kHalfPatch_px = 5;
constexpr int kReach_px = 14;            // 1.8 deg at the paper's focal length
constexpr double kMinContrast = 6;       // standard deviation of a patch, grey levels
constexpr double kMinCorrelation = 0.7;  // of the best place, or the patch was not found again
constexpr std::size_t kMaxPointsOfView = 150;

/// A point of the left eye found again in the right one.
struct Match {
  std::size_t view;
  Vector3d ray;     // where the rig says the right eye sees it, z = 1
  Vector2d offset;  // found - expected, pixels
  double correlation;
  double best_correlation;
};

/// A maximum's place between samples of a parabola, -0.5 .. 0.5.
double between_samples(float before, float at, float after) {
  const double curvature =
      static_cast<double>(before) - 2 * static_cast<double>(at) + static_cast<double>(after);
  if (curvature >= 0) return 0;
  return std::clamp(0.5 * static_cast<double>(before - after) / curvature, -0.5, 0.5);
}

std::optional<Match> find_again(const FlightView& view, const RectifiedRig& rig, const Vector3d& p_camera) {
  constexpr int kPatch = 2 * kHalfPatch_px + 1;
  constexpr int kWindow = kPatch + 2 * kReach_px;
  if (p_camera.z() <= 0) return std::nullopt;
  const Vector3d p_right = rig.T_right_camera() * p_camera;
  const Vector2d left = rig.intrinsics.project(p_camera);
  const Vector2d right = rig.intrinsics.project(p_right);
  constexpr int kLeftMargin = kHalfPatch_px + 1;
  constexpr int kRightMargin = kHalfPatch_px + kReach_px + 1;
  const auto inside = [&](const Vector2d& p, int margin) {
    return p.minCoeff() >= margin && p.x() <= rig.intrinsics.width_px - 1 - margin &&
           p.y() <= rig.intrinsics.height_px - 1 - margin;
  };
  if (!inside(left, kLeftMargin) || !inside(right, kRightMargin)) return std::nullopt;
  cv::Mat patch;
  cv::getRectSubPix(view.left, {kPatch, kPatch}, cv::Point2f(left.cast<float>().x(), left.cast<float>().y()),
                    patch);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(patch, mean, deviation);
  if (deviation[0] < kMinContrast) return std::nullopt;
  cv::Mat window;
  cv::getRectSubPix(view.right, {kWindow, kWindow},
                    cv::Point2f(right.cast<float>().x(), right.cast<float>().y()), window);
  cv::Mat map;
  cv::matchTemplate(window, patch, map, cv::TM_CCOEFF_NORMED);
  double best = 0;
  cv::Point at;
  cv::minMaxLoc(map, nullptr, &best, nullptr, &at);
  if (best < kMinCorrelation || at.x == 0 || at.y == 0 || at.x + 1 == map.cols || at.y + 1 == map.rows)
    return std::nullopt;
  const auto value = [&](int u, int v) { return map.at<float>(at.y + v, at.x + u); };
  const Vector2d offset(at.x - kReach_px + between_samples(value(-1, 0), value(0, 0), value(1, 0)),
                        at.y - kReach_px + between_samples(value(0, -1), value(0, 0), value(0, 1)));
  return Match{0, p_right / p_right.z(), offset, static_cast<double>(map.at<float>(kReach_px, kReach_px)),
               best};
}

std::vector<Match> find_all(const FlightViews& flight, double window_s) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < flight.views.size(); ++i) {
    if (flight.views[i].right.empty()) continue;
    const std::vector<SeenPoint> seen = seen_from(flight, flight.views[i], flight.points, window_s);
    const std::size_t step = seen.size() / kMaxPointsOfView + 1;
    for (std::size_t k = 0; k < seen.size(); k += step) {
      auto match = find_again(flight.views[i], flight.rig, seen[k].T_view_own * seen[k].p_own);
      if (!match) continue;
      match->view = i;
      matches.push_back(*match);
    }
  }
  return matches;
}

template <class Value>
double median_of(const std::vector<Match>& matches, const Value& value) {
  std::vector<double> values;
  for (const Match& match : matches) values.push_back(value(match));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How a pixel moves with a turn of what is seen about the right camera's axes (rotation vector).
Eigen::Matrix<double, 2, 3> by_turn(const Vector3d& ray, const PinholeIntrinsics& k) {
  Eigen::Matrix<double, 2, 3> J;
  J << -k.fx_px * ray.x() * ray.y(), k.fx_px * (1 + ray.x() * ray.x()), -k.fx_px * ray.y(),
      -k.fy_px * (1 + ray.y() * ray.y()), k.fy_px * ray.x() * ray.y(), k.fy_px * ray.x();
  return J;
}

/// Normal equations of each view and their solution, by iteratively reweighted least squares (Geman-McClure).
struct TurnFit {
  Vector3d turn = Vector3d::Zero();
  std::vector<Eigen::Matrix3d> H;
  std::vector<Vector3d> g;
};

TurnFit fit_turn(const std::vector<Match>& matches, std::size_t views, const PinholeIntrinsics& k) {
  TurnFit fit;
  // From wide to narrow, so that the start does not decide which matches count.
  for (const double width_px : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.5, 0.5}) {
    fit.H.assign(views, Eigen::Matrix3d::Zero());
    fit.g.assign(views, Vector3d::Zero());
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-3;
    Vector3d g = Vector3d::Zero();
    for (const Match& match : matches) {
      const Eigen::Matrix<double, 2, 3> J = by_turn(match.ray, k);
      const Vector2d r = match.offset - J * fit.turn;
      const double weight = std::pow(1 + r.squaredNorm() / (width_px * width_px), -2);
      fit.H[match.view] += weight * J.transpose() * J;
      fit.g[match.view] += weight * J.transpose() * r;
      H += weight * J.transpose() * J;
      g += weight * J.transpose() * r;
    }
    fit.turn += H.ldlt().solve(g);
  }
  return fit;
}

/// From how the views' wishes scatter about the solution (a sandwich): matches of one view are not independent.
Vector3d sigma_of(const TurnFit& fit) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity() * 1e-3;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < fit.H.size(); ++i) {
    H += fit.H[i];
    scatter += fit.g[i] * fit.g[i].transpose();
  }
  const Eigen::Matrix3d inverse = H.inverse();
  return (inverse * scatter * inverse).diagonal().cwiseSqrt();
}

}  // namespace

StereoAgreement stereo_agreement(const FlightViews& flight, double window_s) {
  StereoAgreement result;
  const std::vector<Match> matches = find_all(flight, window_s);
  if (matches.empty()) return result;
  result.points = static_cast<int>(matches.size());
  std::vector<char> used(flight.views.size(), 0);
  for (const Match& match : matches) used[match.view] = 1;
  result.views = static_cast<int>(std::count(used.begin(), used.end(), 1));
  result.correlation = median_of(matches, [](const Match& m) { return m.correlation; });
  result.best_correlation = median_of(matches, [](const Match& m) { return m.best_correlation; });
  result.offset_px = median_of(matches, [](const Match& m) { return m.offset.norm(); });
  const TurnFit fit = fit_turn(matches, flight.views.size(), flight.rig.intrinsics);
  result.turn_rad = fit.turn;
  result.sigma_rad = sigma_of(fit);
  return result;
}

}  // namespace alight
