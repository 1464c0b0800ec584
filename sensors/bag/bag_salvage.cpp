#include "sensors/bag/bag_salvage.hpp"

#include <algorithm>

#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

/// A recorder closes a chunk at 768 KiB by default; a single message may be larger.
constexpr std::uint32_t kMaxChunkBytes = 1u << 30;

/// A number of a record inside a chunk.
std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

std::string text_of(const BagFields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

rosbag::CompressionType compression_of(const BagFile& file, const BagRecord& chunk) {
  const std::string name = text_of(chunk.fields, "compression");
  if (name == rosbag::COMPRESSION_NONE) return rosbag::compression::Uncompressed;
  if (name == rosbag::COMPRESSION_BZ2) return rosbag::compression::BZ2;
  if (name == rosbag::COMPRESSION_LZ4) return rosbag::compression::LZ4;
  file.fail(chunk.begin, "a chunk of unknown compression \"" + name + "\"");
}

}  // namespace

BagSalvage::BagSalvage(const std::filesystem::path& path) : file_(path) {
  const std::optional<BagRecord> header = read_bag_header(file_);
  if (!header)
    throw DataError(path.string() + ": is a bag of an older format than 2.0, which only a whole one can be");
  walk(header->end());
  std::stable_sort(messages_.begin(), messages_.end(),
                   [](const Message& a, const Message& b) { return a.receive_ns < b.receive_ns; });
}

/// Up to the first record that is not whole.
void BagSalvage::walk(std::uint64_t at) {
  read_until_ = at;
  try {
    while (at < file_.size()) {
      const BagRecord record = file_.record(at, file_.size());
      const BagOp op = file_.op(record);
      if (op == BagOp::kConnection) {
        add_connection(record.fields, file_.bytes(record.data_begin, record.data_bytes), at);
      } else if (op == BagOp::kChunk) {
        chunks_.push_back(at);
        index_chunk(static_cast<std::uint32_t>(chunks_.size() - 1));
      }
      at = read_until_ = record.end();
    }
  } catch (const DataError& e) {
    lost_reason_ = e.what();
  }
}

void BagSalvage::add_connection(const BagFields& fields, std::string_view data, std::uint64_t at) {
  const std::string id = text_of(fields, "conn");
  if (id.size() != 4) file_.fail(at, "a connection without number");
  const BagFields description = file_.parse_fields(data, at);
  BagConnection connection{text_of(fields, "topic"), text_of(description, "type"),
                           text_of(description, "md5sum"), text_of(description, "message_definition")};
  if (connection.topic.empty() || connection.type.empty())
    file_.fail(at, "a connection without topic or type");
  connections_[read_u32(id, 0)] = std::move(connection);
}

/// The whole chunk or nothing of it: half a chunk would be half of what its messages belong to.
void BagSalvage::index_chunk(std::uint32_t chunk) {
  load_chunk(chunk);
  std::vector<Message> found;
  for (std::uint64_t at = 0; at < content_.size();) {
    const BagRecord record = record_in_chunk(static_cast<std::uint32_t>(at));
    const BagOp op = file_.op(record);
    const std::string_view data = std::string_view(content_).substr(record.data_begin, record.data_bytes);
    if (op == BagOp::kConnection) {
      add_connection(record.fields, data, chunks_[chunk]);
    } else if (op == BagOp::kMessage) {
      const std::string time = text_of(record.fields, "time");
      const auto connection = file_.number<std::uint32_t>(record, "conn");
      if (time.size() != 8 || connections_.count(connection) == 0)
        file_.fail(chunks_[chunk], "a message without time or connection");
      const std::int64_t receive_ns = read_u32(time, 0) * kNanosecondsPerSecond + read_u32(time, 4);
      found.push_back({receive_ns, chunk, static_cast<std::uint32_t>(at), connection});
    }
    at = record.end();
  }
  messages_.insert(messages_.end(), found.begin(), found.end());
}

void BagSalvage::load_chunk(std::uint32_t chunk) {
  if (loaded_ == chunk) return;
  loaded_.reset();
  const BagRecord record = file_.record(chunks_[chunk], file_.size());
  const auto size = file_.number<std::uint32_t>(record, "size");
  if (size > kMaxChunkBytes) file_.fail(record.begin, "a chunk of " + std::to_string(size) + " bytes");
  std::string stored = file_.bytes(record.data_begin, record.data_bytes);
  const rosbag::CompressionType compression = compression_of(file_, record);
  if (compression == rosbag::compression::Uncompressed) {
    content_ = std::move(stored);
    if (content_.size() != size) file_.fail(record.begin, "a chunk whose two sizes differ");
  } else {
    content_.assign(size, '\0');
    try {
      rosbag::ChunkedFile().decompress(compression, reinterpret_cast<std::uint8_t*>(content_.data()), size,
                                       reinterpret_cast<std::uint8_t*>(stored.data()), record.data_bytes);
    } catch (const rosbag::BagException& e) {
      file_.fail(record.begin, std::string("a chunk that does not decompress (") + e.what() + ")");
    }
  }
  loaded_ = chunk;
}

/// Offsets are those of the chunk's content.
BagRecord BagSalvage::record_in_chunk(std::uint32_t offset) const {
  const std::uint64_t chunk_begin = chunks_[*loaded_];
  const std::string_view content = content_;
  BagRecord record;
  record.begin = chunk_begin;
  const auto length_at = [&](std::uint64_t at) {
    if (at + 4 > content.size()) file_.fail(chunk_begin, "a chunk whose records do not fit");
    return read_u32(content, at);
  };
  const std::uint64_t header_begin = std::uint64_t{offset} + 4;
  const std::uint64_t header_end = header_begin + length_at(offset);
  record.data_bytes = length_at(header_end);
  record.data_begin = header_end + 4;
  if (record.end() > content.size()) file_.fail(chunk_begin, "a chunk whose records do not fit");
  record.fields = file_.parse_fields(content.substr(header_begin, header_end - header_begin), chunk_begin);
  return record;
}

std::string_view BagSalvage::data(const Message& message) {
  load_chunk(message.chunk);
  const BagRecord record = record_in_chunk(message.offset);
  return std::string_view(content_).substr(record.data_begin, record.data_bytes);
}

}  // namespace alight
