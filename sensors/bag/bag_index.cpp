#include "sensors/bag/bag_index.hpp"

#include <cstring>

#include "sensors/bag/bag_records.hpp"

namespace alight {
namespace {

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

}  // namespace

std::map<std::string, std::int64_t> indexed_messages(const std::filesystem::path& path) {
  BagFile file(path);
  const std::optional<BagRecord> header = read_bag_header(file);
  if (!header || !has_index(file, *header)) return {};
  std::map<std::uint32_t, std::string> topics;
  std::map<std::string, std::int64_t> messages;
  for (std::uint64_t at = file.number<std::uint64_t>(*header, "index_pos"); at < file.size();) {
    const BagRecord record = file.record(at, file.size());
    const BagOp op = file.op(record);
    if (op == BagOp::kConnection) {
      const auto topic = record.fields.find("topic");
      if (topic == record.fields.end()) file.fail(at, "a connection without topic");
      topics[file.number<std::uint32_t>(record, "conn")] = topic->second;
    }
    if (op == BagOp::kChunkInfo) {
      const std::string counts = file.bytes(record.data_begin, record.data_bytes);
      for (std::size_t i = 0; i + 8 <= counts.size(); i += 8)
        messages[topics[u32_at(counts, i)]] += u32_at(counts, i + 4);
    }
    at = record.end();
  }
  return messages;
}

}  // namespace alight
