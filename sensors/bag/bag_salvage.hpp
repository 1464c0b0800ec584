#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sensors/bag/bag_records.hpp"

namespace alight {

/// One connection of a bag: a publisher of a topic.
struct BagConnection {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Image"
  std::string md5;   ///< of the message definition
  std::string definition;
};

/// A bag without index (its recorder was killed), read as far as its chunks are whole. The messages come in the order of
/// their receive times, as from a bag with index. Memory: 24 bytes a message and one chunk.
class BagSalvage {
 public:
  /// Walks the file. @throws DataError if it cannot be opened or is no bag of format 2.0
  explicit BagSalvage(const std::filesystem::path& path);

  struct Message {
    std::int64_t receive_ns = 0;
    std::uint32_t chunk = 0;
    std::uint32_t offset = 0;  ///< of the record in the chunk
    std::uint32_t connection = 0;
  };
  const std::vector<Message>& messages() const { return messages_; }
  const BagConnection& connection(const Message& message) const {
    return connections_.at(message.connection);
  }
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }

  /// Bytes at the end that could not be read.
  std::uint64_t lost_bytes() const { return file_.size() - read_until_; }
  /// Why they could not.
  const std::string& lost_reason() const { return lost_reason_; }

  /// The serialized message; valid until the next call.
  std::string_view data(const Message& message);

 private:
  void walk(std::uint64_t at);
  void add_connection(const BagFields& fields, std::string_view data, std::uint64_t at);
  void index_chunk(std::uint32_t chunk);
  void load_chunk(std::uint32_t chunk);
  BagRecord record_in_chunk(std::uint32_t offset) const;

  BagFile file_;
  std::uint64_t read_until_ = 0;
  std::string lost_reason_;
  std::vector<std::uint64_t> chunks_;  // where their records begin
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<Message> messages_;
  std::optional<std::uint32_t> loaded_;
  std::string content_;  // of the loaded chunk, decompressed
};

}  // namespace alight
