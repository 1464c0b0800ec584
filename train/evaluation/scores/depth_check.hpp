#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "geometry/rig/rig.hpp"
#include "infer/depth/interpolation.hpp"
#include "infer/depth/self_evaluation.hpp"
#include "train/evaluation/scores/metrics.hpp"

namespace alight {

/// A depth map of whatever origin and the stereo pair that it belongs to, all of one size.
struct DepthCheckInput {
  cv::Mat left, right;  ///< rectified, CV_8UC1 or CV_8UC3 BGR
  cv::Mat depth_m;      ///< CV_32FC1 plane depth of the left camera, 0 = missing
  cv::Mat sparse_m;     ///< CV_32FC1, LiDAR depth for sim_d; empty: none
  cv::Mat truth_m;      ///< CV_32FC1; empty: none
};

/// How a depth map is judged by its stereo pair.
struct DepthCheckConfig {
  StereoTestConfig stereo;
  InterpolationConfig interpolation;
  double lidar_half_fov_deg = 19.174;  ///< sim_d is filled inside; of no effect for a rig without LiDAR
  bool centre_cropped = false;         ///< the images are the centres of what the rig's cameras see
};

/// What the stereo pair says of a depth map.
struct DepthCheckResult {
  StereoScores scores;
  bool paper_accepts = false;              ///< one of the paper's two rules holds
  Verdict verdict = Verdict::kNoEvidence;  ///< with what the configuration asks for besides
  std::optional<PixelErrors> errors;       ///< against the truth
};

/// The paper's self-evaluation (3.2) of any depth map. The rig needs two cameras, and a LiDAR only if sim_d is to be
/// filled inside its field of view alone; the whole image is filled else.
/// @throws DataError naming the map whose size does not fit, ConfigError for a rig that is mono
DepthCheckResult check_depth(const DepthCheckInput& input, const Rig& rig, const DepthCheckConfig& config);

/// The scores, verdict and errors, one a line.
std::string format_check(const DepthCheckResult& result);

}  // namespace alight
