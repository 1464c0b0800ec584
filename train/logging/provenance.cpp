#include "train/logging/provenance.hpp"

#include <algorithm>
#include <vector>

#include "foundation/content_hash.hpp"
#include "foundation/errors.hpp"

extern const char kGitRevision[];  // git_revision.cpp, written by cmake/GitRevision.cmake

namespace alight {
namespace fs = std::filesystem;
namespace {

/// Relative to `dataset` and sorted: a folder lists its files in no particular order.
std::vector<std::string> files_of(const fs::path& dataset) {
  std::vector<std::string> names;
  const auto options = fs::directory_options::follow_directory_symlink;  // flights may lie on another disk
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dataset, options)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(dataset).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool holds_content(const std::string& name) {
  return name == "dataset.yaml" || fs::path(name).filename() == "samples.csv";
}

}  // namespace

std::string git_revision() { return kGitRevision; }

std::string data_hash(const fs::path& dataset) {
  if (!fs::is_regular_file(dataset / "dataset.yaml")) {
    throw DataError((dataset / "dataset.yaml").string() +
                    ": not found; name a data set that alight-dataset build has made");
  }
  std::string listing;
  try {
    for (const std::string& name : files_of(dataset)) {
      const fs::path file = dataset / name;
      listing += name + '\n' + std::to_string(fs::file_size(file)) + '\n';
      if (holds_content(name)) listing += content_hash_of_file(file) + '\n';
    }
  } catch (const fs::filesystem_error& e) {
    throw DataError(dataset.string() + ": cannot be read: " + e.what());
  }
  return content_hash(listing);
}

}  // namespace alight
