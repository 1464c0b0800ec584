#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/rig/stereo_rectification.hpp"

namespace alight {

constexpr int kDatasetFormatVersion = 1;

/// A flight of a data set.
struct FlightEntry {
  std::string name;  ///< the bag's name without .bag; the folder's name
  int samples = 0;
  std::map<std::string, std::int64_t> dropped;  ///< what was left out: reason -> count
  bool has_right = false;
  bool has_dense = false;
};

/// dataset.yaml.
struct DatasetInfo {
  int format_version = kDatasetFormatVersion;
  RectifiedRig rig;           ///< of the cropped images
  double depth_scale = 256;   ///< file value = depth_scale * metres
  double accumulation_s = 0;  ///< length of the window whose points a depth map holds: before + after
  double window_before_s = 0;
  double window_after_s = 0;
  std::vector<FlightEntry> flights;
  std::string config;  ///< the resolved configuration that built it, YAML
};

/// @throws DataError naming the file: not there, not readable, of a newer format version
DatasetInfo read_dataset_info(const std::filesystem::path& dir);

/// @throws DataError naming the file
void write_dataset_info(const std::filesystem::path& dir, const DatasetInfo& info);

}  // namespace alight
