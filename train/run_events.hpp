#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/depth_completion_net.hpp"
#include "train/data/sample_source.hpp"
#include "train/logging/event_file.hpp"

namespace alight {

/// What TensorBoard shows of a run: losses, errors, the weights' distributions, pictures of a held-out sample, and the
/// configuration with the commit and the data that it ran on.
class RunEvents {
 public:
  /// @param continue_after_step of a run that is resumed. @throws DataError
  RunEvents(const std::filesystem::path& run, std::optional<std::int64_t> continue_after_step);

  /// @param config YAML @param provenance lines `key: value`
  void describe(std::int64_t step, const std::string& config, const std::string& provenance);
  void scalars(std::int64_t step, const std::vector<std::pair<std::string, double>>& values);
  /// One histogram a parameter.
  void weights(std::int64_t step, const DepthCompletionNet& net);
  /// Image | points of 0.3 s | prediction from them | prediction from the image alone.
  void panel(std::int64_t step, DepthCompletionNet net, const DepthSample& sample);
  void flush() { file_.flush(); }

 private:
  EventFile file_;
};

}  // namespace alight
