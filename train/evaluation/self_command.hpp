#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train/evaluation/scores/evaluation_config.hpp"

namespace alight {

/// alight-evaluate self: the onboard loop's tests against the truth.
struct SelfOptions {
  std::string checkpoint;
  std::string data;
  std::string output;
  std::string figure;  ///< .png; empty: none
  std::string scores;  ///< .csv; empty: none
  std::string config;  ///< of alight-infer; empty: its defaults
  std::string split;   ///< a configuration of alight-train; empty: all samples
  std::optional<EvaluatedPart> part;
  std::vector<std::string> flights;
  std::vector<std::string> good;  ///< "0.95:0.1:0.01": share, metres, share of the depth; empty: the usual
  std::vector<double> windows_s;  ///< empty: the usual
  int every = 1;
  int threads = 0;
};

/// Returns the exit code and throws as run_tool expects.
int run_self(const SelfOptions& options);

}  // namespace alight
