#pragma once

#include <string>

#include "dataset/build/depth_map_builder.hpp"
#include "foundation/binder_fwd.hpp"
#include "foundation/processes/child_processes.hpp"
#include "sensors/stream/log_config.hpp"

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

/// Of everything but the log itself that a flight's samples depend on: what the format version, the configuration and
/// the rig say, as 32 hexadecimal digits. How hard the pictures are compressed is not among it, nor are the limits.
std::string recipe_of(const DatasetConfig& config, const Rig& rig);

}  // namespace alight
