#pragma once

#include <string>
#include <vector>

#include "foundation/command_line.hpp"

namespace alight {

/// Options of `alight-calibrate lidar`; the side of a square in metres.
struct LidarOptions {
  ConfigOptions config;
  std::vector<std::string> logs;
  std::string rig;
  std::string board;
  double square_m = 0;
  std::string output;
  std::string report;
};

/// `alight-calibrate lidar`: results go to stdout. @returns the exit code. @throws ConfigError, DataError
int run_lidar(const LidarOptions& options);

}  // namespace alight
