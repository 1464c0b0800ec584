#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/rig/stereo_rectification.hpp"
#include "train/data/sample_source.hpp"
#include "train/evaluation/methods/depth_method.hpp"
#include "train/evaluation/scores/evaluation_config.hpp"
#include "train/evaluation/scores/metrics.hpp"

namespace alight {

/// One method with one feeding.
struct EvaluationCell {
  std::array<FlightErrors, kRegions.size()> regions;  ///< in the order of kRegions
  FlightScores similarity;  ///< SSIM of the reconstructed right image a sample; shares only, stereo only

  const FlightErrors& at(Region region) const { return regions.at(static_cast<std::size_t>(region)); }
};

/// How the first method did on one sample with the picture feeding.
struct SampleError {
  EvaluationItem item;
  double rmse_mm = 0;  ///< over the dense truth, else the LiDAR's
};

/// All values of an evaluation, by method, feeding, region, metric and flight.
struct EvaluationReport {
  std::vector<std::pair<std::string, std::string>> about;  ///< what was judged, for the head of a table
  std::vector<std::string> methods;
  std::vector<Feeding> feedings;
  std::vector<std::vector<EvaluationCell>> cells;  ///< [method][feeding]
  std::vector<SampleError> first_method;           ///< a sample each
  RegionConfig regions;
};

/// Completes every sample with every method from every feeding. Where a method knows nothing, the altitude plane stands
/// in and is counted (PixelErrors::substituted). Samples are judged in parallel, the result does not depend on how many
/// at once. @param rig of the data set @param progress called after every sample, by the calling thread
/// @throws DataError as the source
EvaluationReport evaluate(const DepthMethods& methods, SampleSource& source,
                          const std::vector<EvaluationItem>& items, const RectifiedRig& rig,
                          const EvaluationConfig& config, const std::function<void()>& progress = {});

}  // namespace alight
