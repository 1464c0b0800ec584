#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/build/dataset_config.hpp"
#include "dataset/build/flight_build.hpp"
#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// Called now and then with (bytes of the logs that are done, bytes of the logs that have to be built).
using BuildProgress = std::function<void(std::int64_t, std::int64_t)>;

/// How a build runs; nothing of it changes the result.
struct BuildOptions {
  int at_once = 0;  ///< logs that are read at a time; 0: as many as there are cores
  BuildProgress progress;
};

/// What came of a build.
struct BuildResult {
  DatasetInfo info;
  std::vector<std::string> built;   ///< flights that were built
  std::vector<std::string> kept;    ///< flights that were there and up to date
  std::vector<std::string> failed;  ///< one message a log that could not be used
};

/// Builds a data set of logs into `output`, each log in a process of its own, so that one that cannot be read, or
/// crashes its reader, does not stop the others. A new data set appears whole or not at all; to one that is there the
/// logs are added, and what is up to date is not built again. The same logs and configuration give the same bytes,
/// whatever the number of processes. Where `<log without .bag>.truth/depth` is, its true depth is stored too.
/// @throws ConfigError, DataError (no log could be used; `output` is something else, or holds flights of another
/// configuration)
BuildResult build_dataset(const DatasetConfig& config, const Rig& rig,
                          const std::vector<std::filesystem::path>& logs, const std::filesystem::path& output,
                          const BuildOptions& options = {});

}  // namespace alight
