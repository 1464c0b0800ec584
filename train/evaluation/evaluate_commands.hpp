#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foundation/command_line.hpp"
#include "train/evaluation/scores/evaluation_config.hpp"

namespace alight {

/// alight-evaluate: methods over a data set.
struct EvaluateOptions {
  ConfigOptions config;
  std::vector<std::string> checkpoints;  ///< none: the baselines alone
  std::string data;
  std::string output;
  std::vector<std::string> flights;  ///< in place of the configuration's
  std::string split;                 ///< a configuration of alight-train, whose split holds; empty: ours
  std::optional<EvaluatedPart> part;
  std::vector<std::string>
      blocks;            ///< "0.4:0.6": only these parts of the flights, in place of `split` and `part`
  int every = 0;         ///< 0: the configuration's
  std::string pictures;  ///< folder to make; empty: none
  int picture_count = 8;
};

/// alight-evaluate depth: one depth map.
struct DepthOptions {
  std::string rig, left, right, depth, sparse, truth;
  std::string config;  ///< of alight-infer; empty: its defaults
  bool centre_cropped = false;
};

/// Both return the exit code and throw as run_tool expects.
int run_evaluate(const EvaluateOptions& options);
int run_depth(const DepthOptions& options);

}  // namespace alight
