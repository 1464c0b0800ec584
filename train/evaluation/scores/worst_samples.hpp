#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "train/evaluation/scores/evaluator.hpp"

namespace alight {

/// Where a method erred on one sample.
struct ErrorPicture {
  std::string title;
  cv::Mat left;   ///< CV_8UC3 BGR
  cv::Mat fed_m;  ///< CV_32FC1, like all below; 0 = none
  cv::Mat predicted_m;
  cv::Mat truth_m;
};

/// Left image | points fed | prediction | truth | error, with its scale. All depths share one colour scale; the error's
/// ends at its 99th percentile. @returns CV_8UC3 BGR
cv::Mat draw_errors(const ErrorPicture& picture);

/// Draws the `count` samples on which the report's first method has the largest RMSE with the picture feeding:
/// `01_<flight>_<sample>.png` is the worst. @param dir a folder that exists @throws DataError if it cannot be written
void write_worst_samples(const EvaluationReport& report, const DepthMethod& first_method,
                         SampleSource& source, const EvaluationConfig& config, int count,
                         const std::filesystem::path& dir);

}  // namespace alight
