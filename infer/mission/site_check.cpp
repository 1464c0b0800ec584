#include "infer/mission/site_check.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "geometry/reprojection.hpp"

namespace alight {
namespace {

struct Disc {
  int wanted = 0;
  int known = 0;
  int unsafe = 0;
};

/// Ground whose verdict does not come from the unknown beside it.
cv::Mat surely_known(const SiteSelector& selector, const SiteSelection& selection, double metres_per_pixel) {
  const double border_m = selector.judge().doubtful_border_m(metres_per_pixel);
  const int border_px = static_cast<int>(std::ceil(border_m / metres_per_pixel));
  cv::Mat known;
  cv::erode(selection.terrain.known, known, cv::Mat::ones(2 * border_px + 1, 2 * border_px + 1, CV_8UC1),
            {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  return known;
}

/// Pixels of the level image within `radius_px`; those beyond the image are wanted, too.
Disc count_disc(const SiteSelection& selection, const cv::Mat& known, const Eigen::Vector2d& centre_px,
                double radius_px) {
  Disc disc;
  const int reach = static_cast<int>(std::ceil(radius_px));
  const int centre_u = static_cast<int>(std::lround(centre_px.x()));
  const int centre_v = static_cast<int>(std::lround(centre_px.y()));
  for (int v = centre_v - reach; v <= centre_v + reach; ++v) {
    for (int u = centre_u - reach; u <= centre_u + reach; ++u) {
      if (std::hypot(u - centre_px.x(), v - centre_px.y()) > radius_px) continue;
      ++disc.wanted;
      if (u < 0 || v < 0 || u >= selection.safe.cols || v >= selection.safe.rows) continue;
      if (known.at<std::uint8_t>(v, u) == 0) continue;
      ++disc.known;
      disc.unsafe += selection.safe.at<std::uint8_t>(v, u) == 0 ? 1 : 0;
    }
  }
  return disc;
}

/// The widest free circle whose centre is within `nudge_px`; the nearer one of two that are alike.
std::optional<LandingSite> widest_near(const PinholeIntrinsics& camera, const SiteSelection& selection,
                                       const Eigen::Vector2d& centre_px, double nudge_px,
                                       double metres_per_pixel) {
  constexpr double kRadiusPerWay = 0.2;  // a metre of way is worth it for so much more radius
  std::optional<LandingSite> best;
  double best_score = 0;
  const int reach = static_cast<int>(std::ceil(nudge_px));
  for (int dv = -reach; dv <= reach; ++dv) {
    for (int du = -reach; du <= reach; ++du) {
      const double way_px = std::hypot(du, dv);
      if (way_px > nudge_px) continue;
      const auto circle = circle_at(selection, camera, centre_px + Eigen::Vector2d(du, dv));
      if (!circle) continue;
      const double score = circle->radius_m - kRadiusPerWay * way_px * metres_per_pixel;
      if (best && score <= best_score) continue;
      best = circle;
      best_score = score;
    }
  }
  return best;
}

}  // namespace

SiteCheck check_site(const SiteSelector& selector, const SiteSelection& selection,
                     const Eigen::Isometry3d& T_world_camera, const Eigen::Vector3d& p_world,
                     const SiteCheckRule& rule) {
  SiteCheck check;
  check.p_world = p_world;
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, selection.R_level_camera);
  const Eigen::Vector3d p_level = T_world_level.inverse() * p_world;
  if (p_level.z() <= 0 || selection.safe.empty()) return check;
  const PinholeIntrinsics& camera = selector.intrinsics();
  const Eigen::Vector2d centre_px = camera.project(p_level);
  if (!centre_px.allFinite()) return check;
  const double metres_per_pixel = p_level.z() / camera.fx_px;
  const Disc disc = count_disc(selection, surely_known(selector, selection, metres_per_pixel), centre_px,
                               rule.radius_m / metres_per_pixel);
  if (disc.wanted == 0) return check;
  check.known_share = static_cast<double>(disc.known) / disc.wanted;
  check.unsafe_share = disc.known > 0 ? static_cast<double>(disc.unsafe) / disc.known : 0;

  auto circle = circle_at(selection, camera, centre_px);
  check.radius_m = circle ? circle->radius_m : 0;
  const bool too_narrow = check.radius_m < rule.radius_m + 0.5;
  if (rule.nudge_m > 0 && too_narrow) {
    const auto wider =
        widest_near(camera, selection, centre_px, rule.nudge_m / metres_per_pixel, metres_per_pixel);
    if (wider && wider->radius_m > check.radius_m + 0.1) circle = wider;
  }
  if (circle && std::abs(circle->depth_m - p_level.z()) > rule.max_height_step_m) {
    check.verdict = SiteVerdict::kUnsafe;
    return check;
  }
  if (circle) {
    check.radius_m = circle->radius_m;
    check.p_world = T_world_level * circle->p_level;
  }
  if (check.radius_m >= rule.radius_m) {
    check.verdict = SiteVerdict::kSafe;
  } else if (check.known_share < std::min(rule.min_known_share, 0.5)) {
    check.verdict = SiteVerdict::kUnseen;
  } else if (check.unsafe_share > rule.max_unsafe_share) {
    check.verdict = SiteVerdict::kUnsafe;
  } else if (rule.min_known_share < 1 && check.known_share >= rule.min_known_share) {
    check.verdict = SiteVerdict::kSafe;
  }
  return check;
}

}  // namespace alight
