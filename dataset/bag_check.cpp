#include "dataset/bag_check.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "configs/errors.hpp"

namespace alight {
namespace {

constexpr std::uint8_t kFileHeader = 0x03;
constexpr std::uint8_t kIndexData = 0x04;
constexpr std::uint8_t kChunk = 0x05;
constexpr std::uint32_t kIndexEntryBytes = 12;  // time (8), offset in the chunk (4)
constexpr std::uint32_t kMaxHeaderBytes = 1u << 20;

using Fields = std::map<std::string, std::string>;

struct Record {
  std::uint64_t begin = 0;
  Fields fields;
  std::uint64_t data_begin = 0;
  std::uint32_t data_bytes = 0;

  std::uint64_t end() const { return data_begin + data_bytes; }
};

/// Reads records and complains with file and byte.
class BagFile {
 public:
  explicit BagFile(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
    size_ = std::filesystem::file_size(path);
    if (!stream_) throw DataError(path_.string() + ": cannot be opened; check its rights");
  }

  std::uint64_t size() const { return size_; }

  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const {
    throw DataError(path_.string() + ": is cut off or damaged at byte " + std::to_string(at) + ": " + what +
                    "; try: rosbag reindex " + path_.string());
  }

  std::string bytes(std::uint64_t at, std::uint64_t count) {
    std::string text(count, '\0');
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(text.data(), static_cast<std::streamsize>(count));
    if (!stream_) fail(at, "cannot be read");
    return text;
  }

  /// The record at `at`, which has to end before `limit`.
  Record record(std::uint64_t at, std::uint64_t limit) {
    Record record;
    record.begin = at;
    const std::uint32_t header_bytes = length(at, limit);
    if (header_bytes > kMaxHeaderBytes)
      fail(at, "a record header of " + std::to_string(header_bytes) + " bytes");
    const std::uint64_t header_end = at + 4 + header_bytes;
    record.data_bytes = length(header_end, limit);
    record.data_begin = header_end + 4;
    if (record.end() > limit)
      fail(at, "a record of " + std::to_string(record.data_bytes) + " bytes does not fit");
    record.fields = parse(bytes(at + 4, header_bytes), at);
    return record;
  }

  /// A little-endian number out of a header field. @throws DataError if the field is absent or of another
  /// size
  template <class Number>
  Number number(const Record& record, const std::string& name) const {
    const auto found = record.fields.find(name);
    if (found == record.fields.end() || found->second.size() != sizeof(Number)) {
      fail(record.begin, "a record without a usable field \"" + name + "\"");
    }
    Number value;
    std::memcpy(&value, found->second.data(), sizeof(Number));
    return value;
  }

 private:
  std::uint32_t length(std::uint64_t at, std::uint64_t limit) {
    if (at + 4 > limit) fail(at, "a record length does not fit");
    const std::string text = bytes(at, 4);
    std::uint32_t value;
    std::memcpy(&value, text.data(), 4);
    return value;
  }

  Fields parse(const std::string& header, std::uint64_t at) const {
    Fields fields;
    std::size_t i = 0;
    while (i < header.size()) {
      std::uint32_t field_bytes = 0;
      if (i + 4 <= header.size()) std::memcpy(&field_bytes, header.data() + i, 4);
      const std::size_t equals = header.find('=', i + 4);
      if (field_bytes == 0 || field_bytes > header.size() - i - 4 || equals >= i + 4 + field_bytes) {
        fail(at, "a record header whose fields do not fit");
      }
      fields[header.substr(i + 4, equals - i - 4)] =
          header.substr(equals + 1, i + 4 + field_bytes - equals - 1);
      i += 4 + field_bytes;
    }
    return fields;
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

/// A chunk whose index is being checked: where its records begin, or (compressed) only how long it is.
struct ChunkLayout {
  std::uint32_t bytes = 0;
  bool compressed = false;
  std::set<std::uint32_t> record_offsets;
};

ChunkLayout check_chunk(BagFile& file, const Record& chunk) {
  ChunkLayout layout;
  layout.bytes = file.number<std::uint32_t>(chunk, "size");
  const auto compression = chunk.fields.find("compression");
  layout.compressed = compression == chunk.fields.end() || compression->second != "none";
  if (layout.compressed) return layout;
  if (layout.bytes != chunk.data_bytes) file.fail(chunk.begin, "a chunk whose two sizes differ");
  for (std::uint64_t at = chunk.data_begin; at < chunk.end();) {
    layout.record_offsets.insert(static_cast<std::uint32_t>(at - chunk.data_begin));
    at = file.record(at, chunk.end()).end();
  }
  return layout;
}

void check_index(BagFile& file, const Record& index, const ChunkLayout& chunk) {
  const auto count = file.number<std::uint32_t>(index, "count");
  if (std::uint64_t{count} * kIndexEntryBytes != index.data_bytes)
    file.fail(index.begin, "an index of another length");
  const std::string entries = file.bytes(index.data_begin, index.data_bytes);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t offset;
    std::memcpy(&offset, entries.data() + i * kIndexEntryBytes + 8, 4);
    const bool known = chunk.compressed ? offset < chunk.bytes : chunk.record_offsets.count(offset) != 0;
    if (!known) file.fail(index.begin, "an index entry that points at no message");
  }
}

}  // namespace

void check_bag_structure(const std::filesystem::path& path) {
  const std::string magic = "#ROSBAG V2.0\n";
  BagFile file(path);
  if (file.size() < magic.size() || file.bytes(0, 7) != magic.substr(0, 7)) {
    throw DataError(path.string() +
                    ": is no ROS 1 bag (it does not begin with #ROSBAG); check the path of the log");
  }
  if (file.bytes(0, magic.size()) != magic) return;  // format 1.x: rosbag reads or refuses it
  const Record header = file.record(magic.size(), file.size());
  if (file.number<std::uint8_t>(header, "op") != kFileHeader) file.fail(header.begin, "no file header");
  if (file.number<std::uint64_t>(header, "index_pos") == 0) return;
  ChunkLayout chunk;
  for (std::uint64_t at = header.end(); at < file.size();) {
    const Record record = file.record(at, file.size());
    const auto op = file.number<std::uint8_t>(record, "op");
    if (op == kChunk) chunk = check_chunk(file, record);
    if (op == kIndexData) check_index(file, record, chunk);
    at = record.end();
  }
}

}  // namespace alight
