#pragma once

#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "infer/landing/ground/landing_site.hpp"

namespace alight {

/// Which of several sites is the best. The score is the weighted mean of five terms from 0 to 1:
///   size       radius / (radius + min_radius)
///   flatness   1 - slope / max_slope, the steepest slope on the circle
///   clearance  d / (d + obstacle_scale), d from the site's centre to the nearest obstacle
///   nearness   distance_scale / (distance_scale + distance to fly)
///   confidence mean over the circle
struct SiteRankingConfig {
  int max_sites = 5;
  double obstacle_height_m = 0.5;  ///< what rises higher over the site is an obstacle
  double obstacle_scale_m = 5;
  double distance_scale_m = 20;
  double weight_size = 3;
  double weight_flatness = 1;
  double weight_clearance = 1;
  double weight_nearness = 1;
  double weight_confidence = 1;
};
void bind(Binder& b, SiteRankingConfig& c);

/// 0..1. @param min_radius_m, max_slope_rad what a site has to keep
double score(const LandingSite& site, const SiteRankingConfig& config, double min_radius_m,
             double max_slope_rad);

/// Centres of the largest circles that do not share ground: greedy, the largest first; a centre lies farther from every
/// larger circle's rim than min_radius_m.
/// @param radius_m CV_32FC1, radius of the free circle around every pixel or cell
/// @param px_per_m how many pixels a metre is at a place
std::vector<cv::Point> separate_peaks(const cv::Mat& radius_m, int max_count, double min_radius_m,
                                      const std::function<double(const cv::Point&)>& px_per_m);

}  // namespace alight
