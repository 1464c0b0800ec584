#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_salvage.hpp"
#include "sensors/messages/byte_reader.hpp"

namespace alight {

/// One message as it lies in a bag.
struct BagMessage {
  const BagConnection* connection = nullptr;  ///< of BagMessages::connections
  RawMessage raw;
};

/// The messages of a ROS 1 bag in the order in which they were received, undecoded. A bag whose recorder was killed has
/// no index; it is read as far as it goes, with a warning.
class BagMessages {
 public:
  /// @throws DataError naming the file: not there, empty, no bag, cut off or damaged
  explicit BagMessages(const std::filesystem::path& path);
  ~BagMessages();
  BagMessages(BagMessages&&) noexcept;
  BagMessages& operator=(BagMessages&&) noexcept;

  /// Every publisher's topic and type.
  const std::vector<BagConnection>& connections() const;
  /// Bytes at the end of a bag without index that could not be read.
  std::uint64_t lost_bytes() const;

  /// Messages of one topic.
  std::int64_t count(const std::string& topic);

  /// Starts again, with every message, as at first. @returns their number
  std::int64_t select_all();
  /// Starts again, with the messages of these topics. @returns their number
  std::int64_t select(const std::set<std::string>& topics);
  /// Receive times of the first and the last message selected; 0 if there is none.
  std::int64_t begin_ns() const;
  std::int64_t end_ns() const;

  /// The next message selected, valid until the next call; empty at the end. @throws DataError if the bag is damaged
  std::optional<BagMessage> next();

  class Source;

 private:
  std::filesystem::path path_;
  std::unique_ptr<Source> source_;
};

}  // namespace alight
