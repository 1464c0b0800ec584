#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "configs/config_reader.hpp"
#include "dataset/depth_map_builder.hpp"
#include "dataset/flight_log.hpp"
#include "dataset/sample_store.hpp"

namespace alight {

/// What `alight-dataset build` needs to know.
struct DatasetConfig {
  std::string rig = "configs/rigs/paper.yaml";  ///< sensors and their mounting
  LogConfig log;
  DepthMapConfig depth_map;
  double max_neighbour_gap_s = 0.5;  ///< samples farther apart are not previous and next of each other
  int png_compression = 1;
};
void bind(Binder& b, DatasetConfig& c);

/// Called now and then with (file, messages read, messages of the file).
using BuildProgress = std::function<void(const std::filesystem::path&, std::int64_t, std::int64_t)>;

/// Builds a data set of one or more logs into `output`, which appears whole or not at all. The same logs and
/// configuration give the same bytes. Where `<log without .bag>.truth/depth` is, its true depth is stored
/// too.
/// `point_pose` is for tests that show what the alignment corrects.
/// @throws ConfigError, DataError (a log that cannot be read or gives no sample; `output` exists)
DatasetInfo build_dataset(const DatasetConfig& config, const Rig& rig,
                          const std::vector<std::filesystem::path>& logs, const std::filesystem::path& output,
                          const BuildProgress& progress = {}, PointPose point_pose = PointPose::kOwnTime);

/// The rig file of a configuration: as named, or beside the configuration file or a folder above it, so that
/// tools also run from elsewhere.
std::filesystem::path find_rig_file(const std::string& rig, const std::filesystem::path& config_file);

}  // namespace alight
