#pragma once

#include <filesystem>
#include <vector>

#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// One data set of the flights of several. Files are hard links where the file system can, else copies; the parts stay.
/// The result equals what one build of all logs writes.
/// @throws DataError (a part that is no data set, parts of another configuration or rig, a flight in two parts, `output`
/// exists)
DatasetInfo merge_datasets(const std::vector<std::filesystem::path>& parts,
                           const std::filesystem::path& output);

}  // namespace alight
