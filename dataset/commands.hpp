#pragma once

#include <string>
#include <vector>

#include "cli/command_line.hpp"

namespace alight {

struct BuildOptions {
  ConfigOptions config;
  std::vector<std::string> logs;
  std::string output;
};

struct InfoOptions {
  std::string dataset;
  std::string picture;  ///< empty: none
};

struct ViewOptions {
  std::string dataset;
  std::string flight;  ///< empty: the first
  int sample = 0;
  std::string output;
};

/// `alight-dataset build|info|view`: results go to stdout. @returns the exit code. @throws ConfigError,
/// DataError
int run_build(const BuildOptions& options);
int run_info(const InfoOptions& options);
int run_view(const ViewOptions& options);

}  // namespace alight
