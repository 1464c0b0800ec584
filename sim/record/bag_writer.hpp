#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <rosbag/bag.h>

#include "foundation/errors.hpp"
#include "sim/record/message_maker.hpp"
#include "sim/record/sim_config.hpp"

namespace alight::sim {

/// A ROS bag that appears whole or not at all: written as `<path>.partial`, renamed by commit(), removed
/// otherwise. The bytes depend on the messages alone: rosbag stores no wall-clock time.
class BagWriter {
 public:
  /// @throws DataError if `path` exists or cannot be created
  BagWriter(const std::filesystem::path& path, BagCompression compression);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// @param receive_ns since 1970; messages have to come in this order. @throws DataError
  template <class Message>
  void write(const std::string& topic, std::int64_t receive_ns, const Message& message) {
    try {
      bag_.write(topic, to_ros_time(receive_ns), message);
    } catch (const rosbag::BagException& e) {
      throw DataError(path_.string() + ": cannot be written: " + e.what());
    }
  }

  void write(const RecordedMessage& message) {
    std::visit([&](const auto& content) { write(message.topic, message.receive_ns, content); },
               message.content);
  }

  /// @returns the size of the file in bytes. @throws DataError
  std::uintmax_t commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;
  rosbag::Bag bag_;
  bool committed_ = false;
};

}  // namespace alight::sim
