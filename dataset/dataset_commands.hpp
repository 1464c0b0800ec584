#pragma once

#include <string>
#include <vector>

#include "foundation/command_line.hpp"

namespace alight {

/// Options of `alight-dataset build`.
struct BuildArguments {
  ConfigOptions config;
  std::vector<std::string> logs;
  std::string output;
  int jobs = 0;       ///< logs at a time, 0: one a core
  std::string shard;  ///< "i/N": of the logs, only every N-th from the i-th
};

/// Options of `alight-dataset info`.
struct InfoOptions {
  std::string dataset;
  std::string picture;  ///< empty: none
};

/// Options of `alight-dataset view`.
struct ViewOptions {
  std::string dataset;
  std::string flight;  ///< empty: the first
  int sample = 0;
  std::string output;
};

/// Options of `alight-dataset merge`.
struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

/// `alight-dataset build|merge|info|view`: results go to stdout. @returns the exit code. @throws ConfigError,
/// DataError
int run_build(const BuildArguments& arguments);
int run_merge(const MergeArguments& arguments);
int run_info(const InfoOptions& options);
int run_view(const ViewOptions& options);

}  // namespace alight
