#include "sensors/bag/bag_records.hpp"

#include "foundation/errors.hpp"

namespace alight {
namespace {

constexpr std::uint32_t kMaxHeaderBytes = 1u << 20;

}  // namespace

BagFile::BagFile(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
  std::error_code code;
  size_ = std::filesystem::file_size(path, code);
  if (!stream_ || code) throw DataError(path_.string() + ": cannot be opened; check its rights");
}

void BagFile::fail(std::uint64_t at, const std::string& what) const {
  throw DataError(path_.string() + ": is cut off or damaged at byte " + std::to_string(at) + ": " + what +
                  "; try: rosbag reindex " + path_.string());
}

std::string BagFile::bytes(std::uint64_t at, std::uint64_t count) {
  if (at > size_ || count > size_ - at) fail(at, "the file ends early");
  std::string text(count, '\0');
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(at));
  stream_.read(text.data(), static_cast<std::streamsize>(count));
  if (!stream_) fail(at, "cannot be read");
  return text;
}

BagRecord BagFile::record(std::uint64_t at, std::uint64_t limit) {
  BagRecord record;
  record.begin = at;
  const std::uint32_t header_bytes = length(at, limit);
  if (header_bytes > kMaxHeaderBytes)
    fail(at, "a record header of " + std::to_string(header_bytes) + " bytes");
  const std::uint64_t header_end = at + 4 + header_bytes;
  record.data_bytes = length(header_end, limit);
  record.data_begin = header_end + 4;
  if (record.end() > limit)
    fail(at, "a record of " + std::to_string(record.data_bytes) + " bytes does not fit");
  record.fields = parse_fields(bytes(at + 4, header_bytes), at);
  return record;
}

std::uint32_t BagFile::length(std::uint64_t at, std::uint64_t limit) {
  if (at + 4 > limit) fail(at, "a record length does not fit");
  const std::string text = bytes(at, 4);
  std::uint32_t value;
  std::memcpy(&value, text.data(), 4);
  return value;
}

BagFields BagFile::parse_fields(std::string_view header, std::uint64_t at) const {
  BagFields fields;
  std::size_t i = 0;
  while (i < header.size()) {
    std::uint32_t field_bytes = 0;
    if (i + 4 <= header.size()) std::memcpy(&field_bytes, header.data() + i, 4);
    const std::size_t equals = header.find('=', i + 4);
    if (field_bytes == 0 || field_bytes > header.size() - i - 4 || equals >= i + 4 + field_bytes) {
      fail(at, "a record header whose fields do not fit");
    }
    fields[std::string(header.substr(i + 4, equals - i - 4))] =
        header.substr(equals + 1, i + 4 + field_bytes - equals - 1);
    i += 4 + field_bytes;
  }
  return fields;
}

std::optional<BagRecord> read_bag_header(BagFile& file) {
  const std::size_t begins_with = 7;  // "#ROSBAG", of every version
  if (file.size() < kBagMagic.size() || file.bytes(0, begins_with) != kBagMagic.substr(0, begins_with)) {
    throw DataError(file.path().string() +
                    ": is no ROS 1 bag (it does not begin with #ROSBAG); check the path of the log");
  }
  if (file.bytes(0, kBagMagic.size()) != kBagMagic) return std::nullopt;
  BagRecord header = file.record(kBagMagic.size(), file.size());
  if (file.op(header) != BagOp::kFileHeader) file.fail(header.begin, "no file header");
  const auto encryptor = header.fields.find("encryptor");
  if (encryptor != header.fields.end() && !encryptor->second.empty()) {
    throw DataError(file.path().string() + ": is encrypted (" + encryptor->second.substr(0, 60) +
                    "); decrypt it where its GnuPG key is: rosbag decrypt " + file.path().string());
  }
  return header;
}

bool has_index(const BagFile& file, const BagRecord& header) {
  return file.number<std::uint64_t>(header, "index_pos") != 0;
}

}  // namespace alight
