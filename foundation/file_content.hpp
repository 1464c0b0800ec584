#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

namespace alight {

/// All bytes of a file; empty where there is no file that can be read, of which the caller says what it was needed for.
inline std::optional<std::string> file_content(const std::filesystem::path& path) {
  std::error_code code;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path, code)) return std::nullopt;
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) return std::nullopt;
  return content.str();
}

}  // namespace alight
