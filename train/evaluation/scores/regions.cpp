#include "train/evaluation/scores/regions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "geometry/projection.hpp"

namespace alight {
namespace {

Region band_of(double depth_m) {
  if (depth_m < 10) return Region::kBelow10m;
  if (depth_m < 20) return Region::k10To20m;
  return depth_m < 30 ? Region::k20To30m : Region::kAbove30m;
}

}  // namespace

const char* name(Region region) {
  switch (region) {
    case Region::kAll:
      return "all";
    case Region::kHeldOut:
      return "held_out";
    case Region::kDense:
      return "dense";
    case Region::kInsideFov:
      return "inside_fov";
    case Region::kOutsideFov:
      return "outside_fov";
    case Region::kNearEdges:
      return "near_edges";
    case Region::kBelow10m:
      return "below_10m";
    case Region::k10To20m:
      return "10_to_20m";
    case Region::k20To30m:
      return "20_to_30m";
    case Region::kAbove30m:
      break;
  }
  return "above_30m";
}

void bind(Binder& b, RegionConfig& c) {
  b.field("lidar_half_fov_deg", c.lidar_half_fov_deg, "half the opening of the LiDAR's circle",
          between(0.1, 90));
  b.field("edge_step_m", c.edge_step_m, "neighbours whose true depths differ by more are an edge",
          at_least(0));
  b.field("edge_step_share", c.edge_step_share, "if they also differ by more than this share of the nearer",
          at_least(0));
  b.field("edge_distance_px", c.edge_distance_px, "how far from an edge is near", between(0, 100));
}

std::string describe(Region region, const RegionConfig& c) {
  switch (region) {
    case Region::kAll:
      return "LiDAR pixels of the full window";
    case Region::kHeldOut:
      return "LiDAR pixels of the full window that were not fed";
    case Region::kDense:
      return "every pixel with true depth (simulated flights)";
    case Region::kInsideFov:
      return fmt::format(
          "truth inside the LiDAR's field of view at the time of the image, {:g} deg around its boresight",
          c.lidar_half_fov_deg);
    case Region::kOutsideFov:
      return "truth outside the LiDAR's field of view at the time of the image";
    case Region::kNearEdges:
      return fmt::format("truth within {} px of a step of more than {:g} m and {:g} % (simulated flights)",
                         c.edge_distance_px, c.edge_step_m, 100 * c.edge_step_share);
    case Region::kBelow10m:
      return "truth of images whose median depth is below 10 m";
    case Region::k10To20m:
      return "truth of images whose median depth is 10 to 20 m";
    case Region::k20To30m:
      return "truth of images whose median depth is 20 to 30 m";
    case Region::kAbove30m:
      break;
  }
  return "truth of images whose median depth is 30 m or more";
}

cv::Mat near_edges(const cv::Mat& truth_m, const RegionConfig& config) {
  cv::Mat edges = cv::Mat::zeros(truth_m.size(), CV_8UC1);
  const auto mark = [&](cv::Point a, cv::Point b) {
    const auto depth_a = static_cast<double>(truth_m.at<float>(a));
    const auto depth_b = static_cast<double>(truth_m.at<float>(b));
    const double nearer = std::min(depth_a, depth_b);
    const double step = std::abs(depth_a - depth_b);
    if (!(nearer > 0 && step > config.edge_step_m && step > config.edge_step_share * nearer)) return;
    edges.at<std::uint8_t>(a) = edges.at<std::uint8_t>(b) = 255;
  };
  for (int v = 0; v < edges.rows; ++v) {
    for (int u = 0; u < edges.cols; ++u) {
      if (u + 1 < edges.cols) mark({u, v}, {u + 1, v});
      if (v + 1 < edges.rows) mark({u, v}, {u, v + 1});
    }
  }
  const int side = 2 * config.edge_distance_px + 1;
  cv::dilate(edges, edges, cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  return edges;
}

SampleRegions::SampleRegions(const cv::Mat& lidar_m, const cv::Mat& dense_m, const RectifiedRig& rig,
                             const RegionConfig& config)
    : lidar_m_(lidar_m), dense_m_(dense_m), truth_m_(dense_m.empty() ? lidar_m : dense_m) {
  if (lidar_m.size() != rig.intrinsics.size() || truth_m_.size() != rig.intrinsics.size()) {
    throw std::invalid_argument("SampleRegions: depth maps must have the rig's size");
  }
  if (!dense_m.empty()) edges_ = near_edges(dense_m, config);
  const std::optional<double> depth_m = median_depth_m(truth_m_);
  if (!depth_m) return;
  band_ = band_of(*depth_m);
  inside_ =
      lidar_fov_mask(rig.intrinsics, rig.T_camera_lidar, to_radians(config.lidar_half_fov_deg), *depth_m);
}

std::optional<SampleRegions::Pixels> SampleRegions::pixels(Region region, const cv::Mat& fed_m) const {
  if (!band_) return std::nullopt;
  switch (region) {
    case Region::kAll:
      return Pixels{lidar_m_, {}};
    case Region::kHeldOut:
      return Pixels{lidar_m_, fed_m == 0};
    case Region::kDense:
      return dense_m_.empty() ? std::nullopt : std::make_optional(Pixels{dense_m_, {}});
    case Region::kInsideFov:
      return Pixels{truth_m_, inside_};
    case Region::kOutsideFov:
      return Pixels{truth_m_, inside_ == 0};
    case Region::kNearEdges:
      return dense_m_.empty() ? std::nullopt : std::make_optional(Pixels{dense_m_, edges_});
    default:
      return region == *band_ ? std::make_optional(Pixels{truth_m_, {}}) : std::nullopt;
  }
}

}  // namespace alight
