#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// What a data set is like.
struct DatasetStatistics {
  int samples = 0;   ///< of all flights
  int measured = 0;  ///< of these, whose depth maps were looked into: evenly spread
  double height_step_m = 5;
  std::vector<int>
      heights;  ///< samples in [0, step), [step, 2 step), ...; below the take-off place counts as 0
  int unknown_heights = 0;
  /// Accumulation time after the image [s] -> mean share of the image's pixels with a depth: what can be fed as the window of
  /// an onboard engine. Of several points on a pixel a map keeps the one nearest in time, also from before the image: an
  /// engine that only sees those after it has more.
  std::vector<std::pair<double, double>> density;
  double covered_tenth =
      0;  ///< share of the image with a depth over the whole window: a tenth of the samples have less ...
  double covered_median = 0;
  double covered_ninetieth = 0;  ///< ... and a tenth more
  cv::Mat coverage;              ///< CV_32FC1, of each pixel the share of samples in which it has a depth
};

/// @param max_measured depth maps that are read. @throws DataError as read_sample
DatasetStatistics measure_dataset(const std::filesystem::path& dir, const DatasetInfo& info,
                                  int max_measured = 400);

/// As tables.
std::string format_statistics(const DatasetStatistics& statistics);
/// Heights, density over accumulation time, and where in the image there is depth, side by side. CV_8UC3
cv::Mat draw_statistics(const DatasetStatistics& statistics);

}  // namespace alight
