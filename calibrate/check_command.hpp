#pragma once

#include <string>

#include "foundation/command_line.hpp"

namespace alight {

/// Options of `alight-calibrate check`; paths of files and folders.
struct CheckOptions {
  ConfigOptions config;
  std::string log;
  std::string rig;
  std::string report;
};

/// Exit codes of `alight-calibrate check` besides every tool's: kExitOk is a rig that is good.
enum CheckExitCode { kExitMoved = 3, kExitCannotTell = 4 };

/// `alight-calibrate check`: results go to stdout. @returns the exit code. @throws ConfigError, DataError
int run_check(const CheckOptions& options);

}  // namespace alight
