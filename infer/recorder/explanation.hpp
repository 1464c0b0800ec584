#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "foundation/errors.hpp"

namespace alight {

/// Why there was a landing site at a moment, or none.
struct Explanation {
  std::int64_t t_ns = 0;  ///< of the result that is explained: the last one until the moment asked for
  std::string text;       ///< for people, several lines
  cv::Mat picture;        ///< replay_strip's panels; CV_8UC3
};

/// Reads a flight recorder's folder. Scores stand beside the limits they were held to, findings beside what was measured.
/// @param t_ns message time. @throws DataError if there is no record, or none of a result until then
Explanation explain(const std::filesystem::path& record, std::int64_t t_ns);

/// A moment as people write it: message time in nanoseconds (ten digits or more), or seconds from the record's first
/// result on. @throws ConfigError if it is neither
std::int64_t moment_of(const std::filesystem::path& record, const std::string& moment);

/// `alight-infer --explain`: prints the text and writes the picture (PNG). @returns the exit code
int run_explain(const std::filesystem::path& record, const std::string& moment,
                const std::filesystem::path& picture);

}  // namespace alight
