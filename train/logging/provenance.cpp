#include "train/logging/provenance.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

#include "foundation/errors.hpp"

extern const char kGitRevision[];  // git_revision.cpp, written by cmake/GitRevision.cmake

namespace alight {
namespace fs = std::filesystem;
namespace {

/// FNV-1a, 64 bit (Fowler, Noll, Vo).
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  std::string hex() const {
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

std::string read_whole(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream content;
  content << stream.rdbuf();
  if (!stream) throw DataError(path.string() + ": cannot be read; check its rights");
  return content.str();
}

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
  Fnv1a hash;
  try {
    for (const std::string& name : files_of(dataset)) {
      hash.add(name + '\n' + std::to_string(fs::file_size(dataset / name)) + '\n');
      if (holds_content(name)) hash.add(read_whole(dataset / name));
    }
  } catch (const fs::filesystem_error& e) {
    throw DataError(dataset.string() + ": cannot be read: " + e.what());
  }
  return hash.hex();
}

}  // namespace alight
