#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "foundation/errors.hpp"

namespace alight {

/// XXH3 (128 bit) as 32 hexadecimal digits: tells that content is the same, not who made it.
std::string content_hash(std::string_view bytes);
/// The same of a whole file. @throws DataError if it cannot be read
std::string content_hash_of_file(const std::filesystem::path& path);

}  // namespace alight
