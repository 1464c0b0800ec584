#pragma once

#include <filesystem>

#include "foundation/errors.hpp"

namespace alight {

/// Walks the top-level records of a ROS 1 bag (format 2.0, http://wiki.ros.org/Bags/Format/2.0) and checks
/// that every length and header field stays inside the file. rosbag trusts these numbers and crashes on some
/// damaged ones; the walk reads a few bytes a message.
/// @returns false, without having walked, for a bag without index (its recorder was killed)
/// @throws DataError naming the file and the byte
bool check_bag_structure(const std::filesystem::path& path);

}  // namespace alight
