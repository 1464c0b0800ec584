#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/engine_runner.hpp"

namespace alight {

/// One frame as a line of results.jsonl (without line end): t_ns, crop, source, accumulation_s, the scores of both tests
/// (null where there is none), site in the cropped left image or null, wander, reasons, the sensors' health. `with_timings` adds stages_ms,
/// the only part that differs from run to run.
std::string to_json_line(const FrameReport& frame, const cv::Rect& crop, bool with_timings);

/// What a line holds under `health`.
std::string health_json(const HealthReport& health);

/// results.jsonl, line by line.
class ResultWriter {
 public:
  /// @throws DataError if the file cannot be made
  ResultWriter(const std::filesystem::path& path, const cv::Rect& crop, bool with_timings);
  /// @throws DataError if the disk is full
  void write(const FrameReport& frame);

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  cv::Rect crop_;
  bool with_timings_;
};

/// Median and 95th percentile of every stage.
class StageStatistics {
 public:
  void add(const StageTimes& stages_ms);
  /// @param share 0.5 is the median. @throws std::out_of_range for a stage that was never timed
  double percentile_ms(const std::string& stage, double share) const;
  /// One line a stage, with a heading.
  std::string table() const;

 private:
  std::map<std::string, std::vector<double>> samples_ms_;
};

/// What a flight came to, for a page on the terminal.
struct ReplaySummary {
  std::int64_t images = 0;
  std::map<std::string, std::int64_t> by_source;
  std::map<std::string, std::int64_t> none_reasons;
  double accumulation_s = 0;  ///< sum over the images with depth
  std::int64_t sites = 0;
  std::int64_t accepted = 0;
  std::int64_t wandering = 0;
  std::map<std::string, std::int64_t> left_out;  ///< messages and points, reason -> count
  StageStatistics stages;
  std::optional<RunnerStatistics> live;  ///< of a replay in real time
  double live_s = 0;                     ///< its duration

  void add(const FrameReport& frame);
  std::string page() const;
};

}  // namespace alight
