#pragma once

#include <filesystem>
#include <string>

#include "configs/binder_fwd.hpp"
#include "dataset/child_processes.hpp"
#include "dataset/depth_map_builder.hpp"
#include "dataset/log_config.hpp"

namespace alight {

/// What `alight-dataset build` needs to know.
struct DatasetConfig {
  std::string rig = "configs/rigs/paper.yaml";  ///< sensors and their mounting
  LogConfig log;
  DepthMapConfig depth_map;
  double max_neighbour_gap_s = 0.5;  ///< samples farther apart are not previous and next of each other
  int png_compression = 1;
  ChildLimits limits;
};
void bind(Binder& b, DatasetConfig& c);

/// The rig file of a configuration: as named from the working directory; or beside the configuration file or a folder
/// above it; or the shipped one (input_file). Which, is logged where it is not the first.
/// @throws ConfigError as input_file
std::filesystem::path find_rig_file(const std::string& rig, const std::filesystem::path& config_file);

/// Of everything but the log itself that a flight's samples depend on: what the format version, the configuration and
/// the rig say, as 32 hexadecimal digits. How hard the pictures are compressed is not among it, nor are the limits.
std::string recipe_of(const DatasetConfig& config, const Rig& rig);

}  // namespace alight
