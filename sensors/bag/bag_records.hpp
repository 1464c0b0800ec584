#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "foundation/errors.hpp"

/// The records of a ROS 1 bag as they lie in the file (format 2.0, http://wiki.ros.org/Bags/Format/2.0). Every length is
/// checked against what is left before it is used.
namespace alight {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// The field "op" of a record.
enum class BagOp : std::uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

using BagFields = std::map<std::string, std::string>;

/// Where a record lies; offsets in bytes of the file, or of the chunk that holds it.
struct BagRecord {
  std::uint64_t begin = 0;
  BagFields fields;
  std::uint64_t data_begin = 0;
  std::uint32_t data_bytes = 0;

  std::uint64_t end() const { return data_begin + data_bytes; }
};

/// A bag's file; complains with its name and the byte.
class BagFile {
 public:
  /// @throws DataError if it cannot be opened
  explicit BagFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// @throws DataError always
  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const;

  /// @throws DataError if the file ends before
  std::string bytes(std::uint64_t at, std::uint64_t count);

  /// The record at `at`, which has to end before `limit`. @throws DataError if it does not
  BagRecord record(std::uint64_t at, std::uint64_t limit);

  /// A little-endian number of a header field. @throws DataError if the field is absent or of another size
  template <class Number>
  Number number(const BagRecord& record, const std::string& name) const {
    const auto found = record.fields.find(name);
    if (found == record.fields.end() || found->second.size() != sizeof(Number)) {
      fail(record.begin, "a record without a usable field \"" + name + "\"");
    }
    Number value;
    std::memcpy(&value, found->second.data(), sizeof(Number));
    return value;
  }

  BagOp op(const BagRecord& record) const { return static_cast<BagOp>(number<std::uint8_t>(record, "op")); }

  /// The fields of a record's header. @throws DataError, which names byte `at`, if they do not fit
  BagFields parse_fields(std::string_view header, std::uint64_t at) const;

 private:
  std::uint32_t length(std::uint64_t at, std::uint64_t limit);

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

/// The file header; empty for a bag of an older format. @throws DataError if the file does not begin like a bag
std::optional<BagRecord> read_bag_header(BagFile& file);

/// True if the bag was closed: its header says where the index is. False: its recorder was killed.
bool has_index(const BagFile& file, const BagRecord& header);

}  // namespace alight
