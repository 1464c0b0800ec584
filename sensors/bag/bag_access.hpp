#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <rosbag/exceptions.h>

#include "foundation/errors.hpp"

namespace alight {

constexpr std::uint32_t kMaxMessageBytes = 1u << 30;

/// Takes a message's bytes out of rosbag (the `advance` that rosbag::MessageInstance::write asks of its
/// stream).
struct ByteSink {
  std::vector<std::uint8_t> bytes;
  std::uint8_t* advance(std::uint32_t size) {
    if (size > kMaxMessageBytes) throw std::runtime_error("message of " + std::to_string(size) + " bytes");
    bytes.resize(size);
    return bytes.data();
  }
};

/// Runs `body`; whatever rosbag throws becomes a DataError that names the bag and the cure.
template <class Body>
auto with_bag_errors(const std::filesystem::path& path, const Body& body) {
  try {
    return body();
  } catch (const DataError&) {
    throw;
  } catch (const ConfigError&) {
    throw;
  } catch (const rosbag::BagUnindexedException&) {
    throw DataError(path.string() +
                    ": has no index (its recorder was killed); repair it with: rosbag reindex " +
                    path.string());
  } catch (const rosbag::BagIOException& e) {
    throw DataError(path.string() + ": is cut off or no ROS 1 bag: " + e.what());
  } catch (const std::exception& e) {  // BagFormatException, BagException, ros::Exception, std::runtime_error
    throw DataError(path.string() + ": is damaged: " + e.what() + "; try: rosbag reindex " + path.string());
  }
}

/// @throws DataError if there is no file or nothing in it
inline void require_file(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code))
    throw DataError(path.string() + ": no such file; check the path of the log");
  if (!std::filesystem::is_regular_file(path, code))
    throw DataError(path.string() + ": is no file; a log is one ROS 1 bag");
  if (std::filesystem::file_size(path, code) == 0)
    throw DataError(path.string() + ": is empty (0 bytes); record it again");
}

}  // namespace alight
