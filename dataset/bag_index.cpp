#include "dataset/bag_index.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string_view>

#include "configs/errors.hpp"
#include "dataset/messages/byte_reader.hpp"

namespace alight {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint8_t kChunkInfo = 6;
constexpr std::uint8_t kConnection = 7;
constexpr std::size_t kFileHeaderBytes = 4096 + 8;  // of its record: padded content and two lengths

/// A record: named fields, and data that the fields explain.
struct IndexRecord {
  std::map<std::string_view, std::string_view> fields;
  std::string_view data;

  template <class Number>
  Number number(std::string_view name) const {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() != sizeof(Number))
      throw DecodeError("record without " + std::string(name));
    Number value;
    std::memcpy(&value, field->second.data(), sizeof(Number));
    return value;
  }
};

ByteReader reader_of(std::string_view bytes) {
  return ByteReader({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), 0});
}

IndexRecord read_record(ByteReader& reader) {
  IndexRecord record;
  ByteReader header = reader_of(reader.read_string());
  while (header.left() > 0) {
    const std::string_view field = header.read_string();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) throw DecodeError("field without a value");
    record.fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  record.data = reader.read_string();
  return record;
}

std::string read_from(std::ifstream& stream, std::uint64_t begin, std::uint64_t end) {
  std::string bytes(end > begin ? end - begin : 0, '\0');
  stream.seekg(static_cast<std::streamoff>(begin));
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

/// The connections and chunk infos that end a bag.
std::map<std::string, std::int64_t> count(ByteReader reader) {
  std::map<std::uint32_t, std::string> topics;
  std::map<std::string, std::int64_t> messages;
  while (reader.left() > 0) {
    const IndexRecord record = read_record(reader);
    const auto op = record.number<std::uint8_t>("op");
    if (op == kConnection) {
      const auto topic = record.fields.find("topic");
      if (topic == record.fields.end()) throw DecodeError("connection without topic");
      topics[record.number<std::uint32_t>("conn")] = std::string(topic->second);
    }
    if (op != kChunkInfo) continue;
    ByteReader counts = reader_of(record.data);
    while (counts.left() > 0) {
      const std::string& topic = topics[counts.read<std::uint32_t>()];
      messages[topic] += counts.read<std::uint32_t>();
    }
  }
  return messages;
}

}  // namespace

std::map<std::string, std::int64_t> indexed_messages(const std::filesystem::path& path) {
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path, code);
  std::ifstream stream(path, std::ios::binary);
  if (code || !stream) throw DataError(path.string() + ": cannot be read; check the path of the log");
  try {
    const std::string head =
        read_from(stream, 0, std::min<std::uint64_t>(size, kMagic.size() + kFileHeaderBytes));
    if (head.compare(0, kMagic.size(), kMagic) != 0) return {};
    ByteReader reader = reader_of(std::string_view(head).substr(kMagic.size()));
    const auto index_at = read_record(reader).number<std::uint64_t>("index_pos");
    if (index_at == 0 || index_at > size) throw DecodeError("no index");
    const std::string index = read_from(stream, index_at, size);
    return count(reader_of(index));
  } catch (const DecodeError& e) {
    throw DataError(path.string() + ": its index is damaged: " + e.what() + "; try: rosbag reindex " +
                    path.string());
  }
}

}  // namespace alight
