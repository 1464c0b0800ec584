#pragma once

#include <filesystem>
#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// The commit that this program was built from, 40 hex digits; "-dirty" follows where files of it were changed;
/// "unknown" where the source was no git repository.
std::string git_revision();

/// What a data set holds, 32 hex digits: content_hash of a list of all its files, sorted by name, with `name\nsize\n` a
/// file, and `content_hash_of_file\n` after that for dataset.yaml and every samples.csv. Pictures count by their size,
/// which PNG compression changes with nearly any pixel, so that a large data set takes seconds.
/// @throws DataError if the folder has no dataset.yaml or something in it cannot be read
std::string data_hash(const std::filesystem::path& dataset);

}  // namespace alight
