#include "infer/recorder/segment_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include <boost/crc.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "foundation/errors.hpp"
#include "foundation/file_content.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr char kMagic[] = {'A', 'L', 'F', 'R'};
constexpr std::size_t kHeader_bytes = 12;  // magic, length, CRC of length and body
constexpr std::size_t kInBody_bytes = 9;   // time, kind; then the content
constexpr std::uint32_t kMaxBody_bytes = 64'000'000;

template <class Value>
void put(std::string& out, Value value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

template <class Value>
Value get(const std::string& in, std::size_t at) {
  Value value;
  std::memcpy(&value, in.data() + at, sizeof value);
  return value;
}

std::uint32_t crc_of(std::uint32_t length, const char* body) {
  boost::crc_32_type crc;
  crc.process_bytes(&length, sizeof length);
  crc.process_bytes(body, length);
  return crc.checksum();
}

std::string framed(const Record& record) {
  std::string body;
  put(body, record.t_ns);
  put(body, record.kind);
  body += record.content;
  const auto length = static_cast<std::uint32_t>(body.size());
  std::string frame(kMagic, sizeof kMagic);
  put(frame, length);
  put(frame, crc_of(length, body.data()));
  return frame + body;
}

/// The record at a place of a file, and its size; empty if what is there is none or damaged.
std::optional<std::pair<Record, std::size_t>> record_at(const std::string& data, std::size_t at) {
  if (data.size() - at < kHeader_bytes + kInBody_bytes) return std::nullopt;
  if (std::memcmp(data.data() + at, kMagic, sizeof kMagic) != 0) return std::nullopt;
  const auto length = get<std::uint32_t>(data, at + 4);
  if (length < kInBody_bytes || length > kMaxBody_bytes) return std::nullopt;
  if (data.size() - at - kHeader_bytes < length) return std::nullopt;
  if (get<std::uint32_t>(data, at + 8) != crc_of(length, data.data() + at + kHeader_bytes))
    return std::nullopt;
  Record record;
  record.t_ns = get<std::int64_t>(data, at + kHeader_bytes);
  record.kind = get<RecordKind>(data, at + kHeader_bytes + 8);
  record.content = data.substr(at + kHeader_bytes + kInBody_bytes, length - kInBody_bytes);
  return std::make_pair(std::move(record), kHeader_bytes + length);
}

std::vector<fs::path> segments_of(const fs::path& folder) {
  std::vector<fs::path> segments;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".rec") segments.push_back(entry.path());
  }
  std::sort(segments.begin(), segments.end());
  return segments;
}

void read_segment(const fs::path& path, SegmentLogContents& contents) {
  const std::optional<std::string> content = file_content(path);
  if (!content) throw DataError(path.string() + ": cannot be read");
  const std::string& data = *content;
  const std::string magic(kMagic, sizeof kMagic);
  std::size_t at = 0;
  while (at < data.size()) {
    if (auto found = record_at(data, at)) {
      contents.records.push_back(std::move(found->first));
      at += found->second;
      continue;
    }
    std::size_t next = at;
    do {
      next = std::min(data.find(magic, next + 1), data.size());
    } while (next < data.size() && !record_at(data, next));
    contents.damages.push_back(
        path.string() + ": " + std::to_string(next - at) + " bytes at " + std::to_string(at) +
        (next < data.size() ? " are damaged and were skipped" : " are the torn end of a record"));
    at = next;
  }
}

}  // namespace

SegmentWriter::SegmentWriter(fs::path folder, const SegmentLogLimits& limits, Record settings)
    : folder_(std::move(folder)), limits_(limits), settings_(std::move(settings)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw DataError(folder_.string() + ": cannot be made: " + error.message());
  for (const fs::path& segment : segments_of(folder_))
    number_ = std::max<std::int64_t>(number_, std::atoll(segment.stem().c_str()));
}

SegmentWriter::~SegmentWriter() {
  if (file_ < 0) return;
  sync();
  ::close(file_);
}

void SegmentWriter::sync() {
  if (file_ >= 0) ::fdatasync(file_);
}

bool SegmentWriter::append(const Record& record) {
  const auto wanted = static_cast<std::int64_t>(kHeader_bytes + kInBody_bytes + record.content.size());
  if (file_ >= 0 && bytes_ + wanted > limits_.segment_bytes) {
    sync();
    ::close(file_);
    file_ = -1;
  }
  if (file_ < 0 && !open_next()) return false;
  return write_frame(record);
}

bool SegmentWriter::open_next() {
  make_room(limits_.segment_bytes);
  const std::string name = fmt::format("{:08}.rec", number_ + 1);
  const fs::path path = folder_ / name;
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file_ < 0) {
    error_ = path.string() + ": " + std::strerror(errno);
    return false;
  }
  ++number_;
  bytes_ = 0;
  return write_frame(settings_);
}

bool SegmentWriter::write_frame(const Record& record) {
  const std::string frame = framed(record);
  std::size_t written = 0;
  while (written < frame.size()) {
    const ssize_t n = ::write(file_, frame.data() + written, frame.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    written += static_cast<std::size_t>(n);
  }
  if (written == frame.size()) {
    bytes_ += static_cast<std::int64_t>(written);
    error_.clear();
    return true;
  }
  error_ = folder_.string() + ": " + std::strerror(errno);
  // A torn record would be damage in the middle once the disk takes more.
  if (::ftruncate(file_, bytes_) != 0 || ::lseek(file_, bytes_, SEEK_SET) < 0) {
    ::close(file_);
    file_ = -1;
  }
  return false;
}

void SegmentWriter::make_room(std::int64_t bytes) {
  std::vector<fs::path> segments = segments_of(folder_);
  std::int64_t total = bytes;
  std::error_code error;
  for (const fs::path& segment : segments) total += static_cast<std::int64_t>(fs::file_size(segment, error));
  for (const fs::path& segment : segments) {
    if (total <= limits_.total_bytes) return;
    total -= static_cast<std::int64_t>(fs::file_size(segment, error));
    fs::remove(segment, error);
  }
}

SegmentLogContents read_segments(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw DataError(folder.string() + ": is no folder; name that of a flight record");
  const std::vector<fs::path> segments = segments_of(folder);
  if (segments.empty()) throw DataError(folder.string() + ": holds no flight record (*.rec)");
  SegmentLogContents contents;
  for (const fs::path& segment : segments) read_segment(segment, contents);
  return contents;
}

}  // namespace alight
