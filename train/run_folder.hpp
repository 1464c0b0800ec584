#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace alight {

/// The folder of a training run: config.yaml, metrics.csv, last.pt, best.pt, validation.txt. It exists from
/// the first step on, so that a run that is stopped leaves its checkpoints; an earlier run's folder is
/// refused.
class RunFolder {
 public:
  /// @throws DataError if `path` exists and is not an empty folder, or cannot be created
  explicit RunFolder(const std::filesystem::path& path);

  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  /// @throws DataError
  void write(const std::string& name, const std::string& content) const;
  /// Adds a line to metrics.csv. @throws DataError
  void append_metrics(const std::vector<std::string>& cells);

 private:
  std::filesystem::path path_;
  std::ofstream metrics_;
};

}  // namespace alight
