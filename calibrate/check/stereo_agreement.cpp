#include "calibrate/check/stereo_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "calibrate/clocks/patch_search.hpp"
#include "foundation/order_statistics.hpp"

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kExplained_px = 1;
constexpr std::size_t kMaxPointsOfView = 150;

/// A point of the left camera's image found again in the right one's.
struct Match {
  std::size_t view;
  Vector3d ray;  // where the rig says the right camera sees it, z = 1
  PatchMatch patch;
};

std::optional<Match> find_again(const ExposureView& view, const RectifiedRig& rig, const Vector3d& p_camera) {
  if (p_camera.z() <= 0) return std::nullopt;
  const Vector3d p_right = rig.T_right_camera() * p_camera;
  const auto patch =
      find_patch(view.left, rig.intrinsics.project(p_camera), view.right, rig.intrinsics.project(p_right));
  if (!patch) return std::nullopt;
  return Match{0, p_right / p_right.z(), *patch};
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
  return median(values);
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
      const Eigen::Matrix<double, 2, 3> J = pixel_by_turn(match.ray, k);
      const Vector2d r = match.patch.offset - J * fit.turn;
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

double explained_by(const Vector3d& turn, const std::vector<Match>& matches, const PinholeIntrinsics& k) {
  const auto count = std::count_if(matches.begin(), matches.end(), [&](const Match& match) {
    return (match.patch.offset - pixel_by_turn(match.ray, k) * turn).norm() < kExplained_px;
  });
  return static_cast<double>(count) / static_cast<double>(matches.size());
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
  result.correlation = median_of(matches, [](const Match& m) { return m.patch.correlation; });
  result.best_correlation = median_of(matches, [](const Match& m) { return m.patch.best_correlation; });
  result.offset_px = median_of(matches, [](const Match& m) { return m.patch.offset.norm(); });
  const TurnFit fit = fit_turn(matches, flight.views.size(), flight.rig.intrinsics);
  result.turn_rad = fit.turn;
  result.explained = explained_by(fit.turn, matches, flight.rig.intrinsics);
  result.sigma_rad = sigma_of(fit);
  return result;
}

}  // namespace alight
