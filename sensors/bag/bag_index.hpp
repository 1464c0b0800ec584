#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// How many messages the index of a ROS 1 bag (format 2.0, http://wiki.ros.org/Bags/Format/2.0) holds of each topic.
/// rosbag's reader leaves out those whose receive time is no time (zero) without telling how many.
/// Empty for a bag of another format or without index. @throws DataError if the index does not fit its own sizes
std::map<std::string, std::int64_t> indexed_messages(const std::filesystem::path& path);

}  // namespace alight
