#pragma once

#include <string>
#include <vector>

#include "foundation/command_line.hpp"

namespace alight {

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

struct LidarOptions {
  ConfigOptions config;
  std::vector<std::string> logs;
  std::string rig;
  std::string board;
  double square_m = 0;
  std::string output;
  std::string report;
};

struct CheckOptions {
  ConfigOptions config;
  std::string log;
  std::string rig;
  std::string report;
};

/// Exit codes of `alight-calibrate check` besides every tool's: kExitOk is a rig that is good.
enum CheckExitCode { kExitMoved = 3, kExitCannotTell = 4 };

/// `alight-calibrate stereo|lidar|check`: results go to stdout. @returns the exit code. @throws ConfigError, DataError
int run_stereo(const StereoOptions& options);
int run_lidar(const LidarOptions& options);
int run_check(const CheckOptions& options);

}  // namespace alight
