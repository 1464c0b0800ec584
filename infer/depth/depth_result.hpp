#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "infer/depth/self_evaluation.hpp"
#include "infer/depth/stage_times.hpp"

namespace alight {

/// Where the depth of a result comes from.
enum class DepthSource {
  kNone,      ///< there is none to be trusted; `reason` says why
  kImage,     ///< predicted from the image alone, and trusted
  kLidar,     ///< predicted from the image and LiDAR, and trusted
  kFallback,  ///< nearest-neighbour interpolation of the LiDAR
};
/// "none", "image", "lidar", "fallback"
const char* name(DepthSource source);

/// Values of DepthResult::pixel_source.
enum class PixelSource : std::uint8_t {
  kUnknown = 0,
  kPredicted = 1,     ///< inside the LiDAR's field of view, where its points can contradict
  kInterpolated = 2,  ///< between LiDAR points; never outside its field of view
  kPredictedOutsideFov = 3,
};

/// What the engine knows about one left image.
struct DepthResult {
  std::int64_t t_ns = 0;
  DepthSource source = DepthSource::kNone;
  std::string reason;         ///< why this source: what was not trusted, or what was missing
  double accumulation_s = 0;  ///< LiDAR time in `depth_m`
  int predictions = 0;        ///< runs of the network's depth branch and decoder
  StereoScores stereo;        ///< of the last prediction
  HoldoutScores holdout;      ///< of the last prediction
  Verdict stereo_verdict = Verdict::kNoEvidence;
  Verdict holdout_verdict = Verdict::kNoEvidence;

  cv::Mat depth_m;       ///< CV_32FC1 plane depth, 0 = unknown; empty for kNone
  cv::Mat pixel_source;  ///< CV_8UC1 of PixelSource; empty for kNone
  cv::Mat left;          ///< rectified, cropped left image; empty if the image was never opened
  cv::Mat sparse_m;      ///< CV_32FC1, the LiDAR points in `depth_m`, 0 = no point; empty if never opened
  std::optional<Eigen::Isometry3d> T_world_camera;
  StageTimes stages_ms;
};

}  // namespace alight
