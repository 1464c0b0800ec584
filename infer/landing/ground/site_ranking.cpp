#include "infer/landing/ground/site_ranking.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, SiteRankingConfig& c) {
  b.field("max_sites", c.max_sites, "so many separate sites are reported", between(1, 100));
  b.field("obstacle_height_m", c.obstacle_height_m, "what rises higher over a site is an obstacle",
          between(0.05, 100));
  b.field("obstacle_scale_m", c.obstacle_scale_m, "distance to an obstacle that is worth half the term",
          between(0.1, 1000));
  b.field("distance_scale_m", c.distance_scale_m, "distance to fly that costs half the term",
          between(0.1, 10000));
  b.field("weight_size", c.weight_size, "of the circle's radius", between(0, 100));
  b.field("weight_flatness", c.weight_flatness, "of its steepest slope", between(0, 100));
  b.field("weight_clearance", c.weight_clearance, "of its distance to obstacles", between(0, 100));
  b.field("weight_nearness", c.weight_nearness, "of the distance to fly", between(0, 100));
  b.field("weight_confidence", c.weight_confidence, "of the depth's confidence", between(0, 100));
  b.check("weight_size", c.weight_size > 0, "must be positive: the largest circle has to count");
}

double score(const LandingSite& site, const SiteRankingConfig& c, double min_radius_m, double max_slope_rad) {
  const double size = site.radius_m / (site.radius_m + min_radius_m);
  const double flatness = std::clamp(1 - site.slope_rad / max_slope_rad, 0.0, 1.0);
  const double clearance = site.obstacle_m / (site.obstacle_m + c.obstacle_scale_m);
  const double nearness = c.distance_scale_m / (c.distance_scale_m + site.distance_m);
  const double confidence = std::clamp(site.confidence, 0.0, 1.0);
  const double weights =
      c.weight_size + c.weight_flatness + c.weight_clearance + c.weight_nearness + c.weight_confidence;
  return (c.weight_size * size + c.weight_flatness * flatness + c.weight_clearance * clearance +
          c.weight_nearness * nearness + c.weight_confidence * confidence) /
         weights;
}

std::vector<cv::Point> separate_peaks(const cv::Mat& radius_m, int max_count, double min_radius_m,
                                      const std::function<double(const cv::Point&)>& px_per_m) {
  std::vector<cv::Point> peaks;
  cv::Mat left = radius_m.clone();
  while (static_cast<int>(peaks.size()) < max_count) {
    double largest_m = 0;
    cv::Point at;
    cv::minMaxLoc(left, nullptr, &largest_m, nullptr, &at);
    if (largest_m <= (peaks.empty() ? 0.0 : min_radius_m)) break;
    peaks.push_back(at);
    const double reach_px = (largest_m + min_radius_m) * px_per_m(at);
    cv::circle(left, at, static_cast<int>(std::ceil(std::min(reach_px, 1e4))), cv::Scalar(0), cv::FILLED);
  }
  return peaks;
}

}  // namespace alight
