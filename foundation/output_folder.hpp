#pragma once

#include <filesystem>
#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// A folder that appears whole or not at all: files go to `<path>.partial`, commit() renames it. An
/// uncommitted folder is removed. Whatever a user already has under `path` is refused, never overwritten.
class OutputFolder {
 public:
  /// @throws DataError if `path` exists (and is not an empty folder) or cannot be created. A leftover
  /// `<path>.partial` of a killed run is replaced.
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until commit().
  const std::filesystem::path& partial() const { return partial_; }
  /// @throws DataError if the rename fails.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;
  bool committed_ = false;
};

/// Writes a file under a temporary name, then renames it over `path`. @throws DataError
void write_file_atomically(const std::filesystem::path& path, const std::string& content);

}  // namespace alight
