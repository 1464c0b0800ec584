#pragma once

#include <filesystem>
#include <vector>

#include "sim/record/board_scene.hpp"

namespace alight::sim {

/// Records a board in front of the rig: `board_00.bag` and so on, each with both cameras and the LiDAR but no pose, as from
/// a rig on a stand; `rig.yaml` as it is before a calibration (no LiDAR mounting); `truth/rig.yaml`. The folder appears
/// whole or not at all, its bytes depend on the configuration alone.
/// @returns the bags. @throws ConfigError for a rig or board that cannot be recorded, DataError if `output` exists
std::vector<std::filesystem::path> record_boards(const BoardSceneConfig& config,
                                                 const std::filesystem::path& output);

}  // namespace alight::sim
