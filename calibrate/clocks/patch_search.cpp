#include "calibrate/clocks/patch_search.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

using Eigen::Vector2d;

constexpr int kHalfPatch_px = 5;
constexpr int kReach_px = 14;            // 1.8 deg at the paper's focal length
constexpr double kMinContrast = 6;       // standard deviation of a patch, grey levels
constexpr double kMinCorrelation = 0.7;  // of the best place, or the patch was not found again

/// A maximum's place between samples of a parabola, -0.5 .. 0.5.
double between_samples(float before, float at, float after) {
  const double curvature =
      static_cast<double>(before) - 2 * static_cast<double>(at) + static_cast<double>(after);
  if (curvature >= 0) return 0;
  return std::clamp(0.5 * static_cast<double>(before - after) / curvature, -0.5, 0.5);
}

bool inside(const cv::Mat& image, const Vector2d& p, int margin) {
  return p.minCoeff() >= margin && p.x() <= image.cols - 1 - margin && p.y() <= image.rows - 1 - margin;
}

cv::Mat cut(const cv::Mat& image, const Vector2d& centre, int size) {
  cv::Mat patch;
  cv::getRectSubPix(image, {size, size},
                    cv::Point2f(static_cast<float>(centre.x()), static_cast<float>(centre.y())), patch);
  return patch;
}

}  // namespace

std::optional<PatchMatch> find_patch(const cv::Mat& from, const Vector2d& at, const cv::Mat& to,
                                     const Vector2d& expected) {
  constexpr int kPatch = 2 * kHalfPatch_px + 1;
  if (!inside(from, at, kHalfPatch_px + 1) || !inside(to, expected, kHalfPatch_px + kReach_px + 1))
    return std::nullopt;
  const cv::Mat patch = cut(from, at, kPatch);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(patch, mean, deviation);
  if (deviation[0] < kMinContrast) return std::nullopt;
  cv::Mat map;
  cv::matchTemplate(cut(to, expected, kPatch + 2 * kReach_px), patch, map, cv::TM_CCOEFF_NORMED);
  double best = 0;
  cv::Point place;
  cv::minMaxLoc(map, nullptr, &best, nullptr, &place);
  const bool at_border = place.x == 0 || place.y == 0 || place.x + 1 == map.cols || place.y + 1 == map.rows;
  if (best < kMinCorrelation || at_border) return std::nullopt;
  const auto value = [&](int u, int v) { return map.at<float>(place.y + v, place.x + u); };
  PatchMatch match;
  match.offset = {place.x - kReach_px + between_samples(value(-1, 0), value(0, 0), value(1, 0)),
                  place.y - kReach_px + between_samples(value(0, -1), value(0, 0), value(0, 1))};
  match.correlation = static_cast<double>(map.at<float>(kReach_px, kReach_px));
  match.best_correlation = best;
  return match;
}

Eigen::Matrix<double, 2, 3> pixel_by_turn(const Eigen::Vector3d& ray, const PinholeIntrinsics& k) {
  Eigen::Matrix<double, 2, 3> J;
  J << -k.fx_px * ray.x() * ray.y(), k.fx_px * (1 + ray.x() * ray.x()), -k.fx_px * ray.y(),
      -k.fy_px * (1 + ray.y() * ray.y()), k.fy_px * ray.x() * ray.y(), k.fy_px * ray.x();
  return J;
}

}  // namespace alight
