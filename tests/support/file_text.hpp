#pragma once

#include <filesystem>
#include <string>

#include "foundation/file_content.hpp"

namespace alight::test {

/// All bytes of a file, none where it cannot be read: what a test then expects of them fails.
inline std::string file_text(const std::filesystem::path& path) { return file_content(path).value_or(""); }

}  // namespace alight::test
