#pragma once

#include <string>

#include "foundation/command_line.hpp"

namespace alight {

/// Options of `alight-calibrate stereo`; the side of a square in metres.
struct StereoOptions {
  ConfigOptions config;
  std::string left;  ///< files, with * and ?
  std::string right;
  std::string log;
  std::string left_topic;
  std::string right_topic;
  std::string board;
  double square_m = 0;
  std::string output;
  std::string report;
};

/// `alight-calibrate stereo`: results go to stdout. @returns the exit code. @throws ConfigError, DataError
int run_stereo(const StereoOptions& options);

}  // namespace alight
