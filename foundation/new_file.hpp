#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"

namespace alight {

/// A file that a tool is to make: refused at the start where something is there already, written whole at the end.
class NewFile {
 public:
  /// @throws ConfigError if no name was given, DataError if the file exists
  explicit NewFile(const std::filesystem::path& path) : path_(path) {
    if (path_.empty()) throw ConfigError("--output: is missing; name the file to write");
    std::error_code code;
    if (std::filesystem::exists(path_, code))
      throw DataError(path_.string() +
                      ": exists already and is not overwritten; remove it or name another file");
  }
  /// @throws DataError
  void write(const std::string& content) const { write_file_atomically(path_, content); }

 private:
  std::filesystem::path path_;
};

}  // namespace alight
