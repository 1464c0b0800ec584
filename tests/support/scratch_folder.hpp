#pragma once

#include <filesystem>

#include <sys/types.h>

namespace alight::test {

/// A new, empty folder that nobody else has, under `TMPDIR` (or /tmp). It is removed with all it holds when the object
/// ends, but not by a forked child that inherited the object.
class ScratchFolder {
 public:
  /// @throws std::system_error if the folder cannot be made
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Where a file of this name in the folder is.
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
  pid_t owner_;
};

}  // namespace alight::test
