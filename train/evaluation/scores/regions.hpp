#pragma once

#include <array>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/rig/stereo_rectification.hpp"

namespace alight {

/// Pixels that are judged apart, because a mean over all hides where a network earns its place (METHOD, "The opponent").
/// From kInsideFov on the truth is the dense one where the sample has it, else the full LiDAR window.
enum class Region {
  kAll,         ///< LiDAR pixels of the full window
  kHeldOut,     ///< those of them that were not fed
  kDense,       ///< true depth, simulated flights only
  kInsideFov,   ///< inside the LiDAR's instantaneous field of view
  kOutsideFov,  ///< outside of it
  kNearEdges,   ///< near an edge of the true depth, simulated flights only
  kBelow10m,    ///< images whose median true depth is below 10 m
  k10To20m,
  k20To30m,
  kAbove30m,
};
constexpr std::array<Region, 10> kRegions{
    Region::kAll,       Region::kHeldOut,  Region::kDense,   Region::kInsideFov, Region::kOutsideFov,
    Region::kNearEdges, Region::kBelow10m, Region::k10To20m, Region::k20To30m,   Region::kAbove30m};
/// Name for files, such as held_out.
const char* name(Region region);

/// Where the regions end; metres and degrees.
struct RegionConfig {
  double lidar_half_fov_deg = 19.174;  ///< the Mid-40's circle
  /// An edge lies between neighbouring pixels (left and right, above and below) whose true depths differ by more than
  /// both of these.
  double edge_step_m = 0.5;
  double edge_step_share = 0.03;  ///< of the nearer depth
  int edge_distance_px = 3;       ///< how far "near" is
};
void bind(Binder& b, RegionConfig& c);

/// What a region is, in a sentence for readers of a table.
std::string describe(Region region, const RegionConfig& config);

/// Pixels within edge_distance_px of an edge of `truth_m` (CV_32FC1, 0 = none). @returns CV_8UC1, 255 near
cv::Mat near_edges(const cv::Mat& truth_m, const RegionConfig& config);

/// The regions of one sample.
class SampleRegions {
 public:
  /// The truth of a region and which of its pixels belong.
  struct Pixels {
    cv::Mat truth_m;  ///< CV_32FC1, 0 = none
    cv::Mat mask;     ///< CV_8UC1; empty: all
  };

  /// @param lidar_m CV_32FC1, full window @param dense_m CV_32FC1, empty: none
  /// @throws std::invalid_argument if a map does not have the rig's size
  SampleRegions(const cv::Mat& lidar_m, const cv::Mat& dense_m, const RectifiedRig& rig,
                const RegionConfig& config);

  /// Empty if the sample has none of the region. @param fed_m CV_32FC1, 0 = not fed
  std::optional<Pixels> pixels(Region region, const cv::Mat& fed_m) const;

 private:
  cv::Mat lidar_m_;
  cv::Mat dense_m_;
  cv::Mat truth_m_;  // the dense one, else the LiDAR's
  cv::Mat inside_;
  cv::Mat edges_;
  std::optional<Region> band_;
};

}  // namespace alight
