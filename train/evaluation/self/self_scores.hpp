#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "infer/depth/image_task.hpp"
#include "train/data/sample_source.hpp"
#include "train/evaluation/methods/depth_method.hpp"
#include "train/evaluation/scores/evaluation_config.hpp"

namespace alight {

/// When a depth map is good enough to look for a landing site in it: this share of the pixels with true depth is within
/// the larger one of two tolerances. The lowest step that the site selection tells from flat ground is 9 cm
/// (DerivativesConfig), so an error of 10 cm is the least that makes or hides an obstacle; 1 % is 10 cm at 10 m, where a
/// vehicle that descends decides. The rest of the pixels are edges, which are unsafe ground in any case.
struct GoodDepth {
  double share = 0.9;
  double error_m = 0.10;
  double error_relative = 0.01;  ///< of the true depth
};
/// Good enough, and a stricter and a laxer definition that show how much hangs on the first.
inline std::vector<GoodDepth> usual_definitions() { return {{}, {0.95, 0.10, 0.01}, {0.8, 0.10, 0.01}}; }

/// Share of the pixels with true depth that are within the tolerance; unknown pixels are not. 0 without truth.
/// @param predicted_m CV_32FC1, 0 or not finite = unknown @param truth_m CV_32FC1, 0 = none
double share_within(const cv::Mat& predicted_m, const cv::Mat& truth_m, const GoodDepth& tolerance);

/// Where a scored depth map comes from. All but the first are there to have wrong depth of known kinds.
enum class MapOrigin {
  kNetwork,
  kAltitudePlane,  ///< level ground at the reported height
  kWrongHeight,    ///< the network, told a height that is too large
  kTooFar,         ///< the network's depth, stretched
  kTooNear,        ///< the network's depth, shrunk
  kDelaunay,       ///< linear interpolation of the fed points
};
/// For files, such as wrong_height.
const char* name(MapOrigin origin);

/// Which maps are made, and which of them count as good.
struct SelfScoreConfig {
  ImageTaskConfig image;                            ///< the tests, as the onboard loop applies them
  std::vector<double> windows_s{0, 0.1, 0.3, 1.0};  ///< LiDAR time fed, from the image on; 0: the image alone
  double holdout_s = 0.1;  ///< the LiDAR packet after it, which the hold-out test sees
  std::vector<GoodDepth> good = usual_definitions();  ///< the first counts
  double height_factor = 1.15;                        ///< kWrongHeight
  double depth_factor = 1.1;                          ///< kTooFar; kTooNear is as much less than 1
  int threads = 0;                                    ///< samples at once; 0: all cores
};

/// One depth map: what the tests say of it, and what is true.
struct MapScores {
  std::string flight;
  std::size_t sample = 0;  ///< of the data set
  double window_s = 0;
  MapOrigin origin = MapOrigin::kNetwork;
  double depth_m = 0;                ///< median of the truth
  std::vector<double> share_within;  ///< a definition of good each
  std::vector<bool> good;            ///< so is this
  StereoScores stereo;               ///< with the peak, also where the onboard loop does not need it
  HoldoutScores holdout;
  Verdict stereo_verdict = Verdict::kNoEvidence;
  Verdict holdout_verdict = Verdict::kNoEvidence;
};

/// The maps of every sample, in the order of `items`. sim_d is made from the points fed and those held out: when the
/// onboard loop judges, both are there. Kinds of maps that need fed points are left out where there are none.
/// @throws DataError for a sample without the dense truth, which simulated flights have, and as the source
std::vector<MapScores> score_maps(const DepthMethod& network, SampleSource& source,
                                  const std::vector<EvaluationItem>& items, const RectifiedRig& rig,
                                  const SelfScoreConfig& config, const std::function<void()>& progress = {});

}  // namespace alight
