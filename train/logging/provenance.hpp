#pragma once

#include <filesystem>
#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// The commit that this program was built from, 40 hex digits; "-dirty" follows where files of it were changed;
/// "unknown" where the source was no git repository.
std::string git_revision();

/// What a data set holds, 16 hex digits: FNV-1a (64 bit) over the names and sizes of all its files and the content of
/// dataset.yaml and of every samples.csv. Pictures count by their size, which PNG compression changes with nearly any
/// pixel, so that a large data set takes seconds. Tells data sets apart; is no protection against forgery.
/// @throws DataError if the folder has no dataset.yaml or something in it cannot be read
std::string data_hash(const std::filesystem::path& dataset);

}  // namespace alight
