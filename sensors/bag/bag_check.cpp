#include "sensors/bag/bag_check.hpp"

#include <set>

#include "sensors/bag/bag_records.hpp"

namespace alight {
namespace {

constexpr std::uint32_t kIndexEntryBytes = 12;  // time (8), offset in the chunk (4)

/// A chunk whose index is being checked: where its messages begin, or (compressed) only how long it is.
struct ChunkLayout {
  std::uint64_t begin = 0;
  std::uint32_t bytes = 0;
  bool compressed = false;
  std::set<std::uint32_t> message_offsets;  // those that no index entry has pointed at yet
};

ChunkLayout check_chunk(BagFile& file, const BagRecord& chunk) {
  ChunkLayout layout;
  layout.begin = chunk.begin;
  layout.bytes = file.number<std::uint32_t>(chunk, "size");
  const auto compression = chunk.fields.find("compression");
  layout.compressed = compression == chunk.fields.end() || compression->second != "none";
  if (layout.compressed) return layout;
  if (layout.bytes != chunk.data_bytes) file.fail(chunk.begin, "a chunk whose two sizes differ");
  for (std::uint64_t at = chunk.data_begin; at < chunk.end();) {
    const BagRecord record = file.record(at, chunk.end());
    if (file.op(record) == BagOp::kMessage)
      layout.message_offsets.insert(static_cast<std::uint32_t>(at - chunk.data_begin));
    at = record.end();
  }
  return layout;
}

void check_index(BagFile& file, const BagRecord& index, ChunkLayout& chunk) {
  const auto count = file.number<std::uint32_t>(index, "count");
  if (std::uint64_t{count} * kIndexEntryBytes != index.data_bytes)
    file.fail(index.begin, "an index of another length");
  const std::string entries = file.bytes(index.data_begin, index.data_bytes);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t offset;
    std::memcpy(&offset, entries.data() + i * kIndexEntryBytes + 8, 4);
    const bool known = chunk.compressed ? offset < chunk.bytes : chunk.message_offsets.erase(offset) != 0;
    if (!known) file.fail(index.begin, "an index entry that points at no message");
  }
}

/// rosbag passes over messages that the index does not know.
void require_indexed(const BagFile& file, const ChunkLayout& chunk) {
  if (!chunk.message_offsets.empty())
    file.fail(chunk.begin, "a chunk with messages that the index does not know");
}

}  // namespace

bool check_bag_structure(const std::filesystem::path& path) {
  BagFile file(path);
  const std::optional<BagRecord> header = read_bag_header(file);
  if (!header) return true;  // format 1.x: rosbag reads or refuses it
  if (!has_index(file, *header)) return false;
  ChunkLayout chunk;
  for (std::uint64_t at = header->end(); at < file.size();) {
    const BagRecord record = file.record(at, file.size());
    const BagOp op = file.op(record);
    if (op == BagOp::kChunk) {
      require_indexed(file, chunk);
      chunk = check_chunk(file, record);
    }
    if (op == BagOp::kIndexData) check_index(file, record, chunk);
    at = record.end();
  }
  require_indexed(file, chunk);
  return true;
}

}  // namespace alight
