#pragma once

#include <filesystem>
#include <string>

namespace alight {

/// The rig file of a configuration: as named from the working directory; or beside the configuration file or a folder
/// above it; or the shipped one (input_file). Which, is logged where it is not the first.
/// @throws ConfigError as input_file
std::filesystem::path find_rig_file(const std::string& rig, const std::filesystem::path& config_file);

}  // namespace alight
