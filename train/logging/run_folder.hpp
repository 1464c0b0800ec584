#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "foundation/errors.hpp"

namespace alight {

/// The folder of a training run: config.yaml, provenance.yaml (commit and data), metrics.csv, TensorBoard events, last.pt,
/// best.pt, validation.txt. It exists from
/// the first step on, so that a run that is stopped leaves its checkpoints; an earlier run's folder is
/// refused unless it is asked for.
class RunFolder {
 public:
  enum class Open { kNew, kExisting };

  /// @throws DataError kNew: `path` exists and is not an empty folder, or cannot be created; kExisting: it is no run
  explicit RunFolder(const std::filesystem::path& path, Open open = Open::kNew);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  bool has(const std::string& name) const;
  /// @throws DataError
  void write(const std::string& name, const std::string& content) const;
  /// @throws DataError
  std::string read(const std::string& name) const;
  /// Adds a line to metrics.csv. @throws DataError
  void append_metrics(const std::vector<std::string>& cells);
  /// Leaves the rows of metrics.csv whose first cell, the epoch, is no more than this; the head goes with the last of
  /// them. @throws DataError
  void keep_metrics(std::int64_t epochs);

 private:
  std::filesystem::path path_;
  std::ofstream metrics_;
};

}  // namespace alight
