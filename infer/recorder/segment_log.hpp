#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "foundation/errors.hpp"

namespace alight {

/// What a record of a flight holds.
enum class RecordKind : std::uint8_t {
  kSettings = 'S',  ///< YAML of RecordedSettings; the first of every segment
  kFrame = 'F',     ///< JSON of one result
  kHealth = 'H',    ///< JSON of a change of the sensors' health
  kLeft = 'L',      ///< JPEG of the left image, small
  kDepth = 'D',     ///< PNG, 16 bit, 1/256 m: depth, small
  kSafe = 'M',      ///< PNG, 8 bit: 255 safe, 128 known, 0 unknown; seen level, small
};

/// One thing at one message time.
struct Record {
  RecordKind kind = RecordKind::kFrame;
  std::int64_t t_ns = 0;
  std::string content;
};

/// How much room a log may take.
struct SegmentLogLimits {
  std::int64_t segment_bytes = 16'000'000;  ///< a file that has grown beyond is closed
  std::int64_t total_bytes = 500'000'000;   ///< of all files; the oldest goes before more would be held
};

/// Records in files `<number>.rec` of one folder, each a frame of magic, length and CRC-32 around its content, so that a
/// reader finds its way past any damage. A record is one write(2): it is the kernel's once append() returns, and a killed
/// process loses at most the one it was writing. sync() puts it on the disk, for the loss of power.
class SegmentWriter {
 public:
  /// Goes on after the highest number in `folder`, which is made if it is missing. @param settings begins every file
  /// @throws DataError if the folder cannot be made
  SegmentWriter(std::filesystem::path folder, const SegmentLogLimits& limits, Record settings);
  ~SegmentWriter();
  SegmentWriter(const SegmentWriter&) = delete;
  SegmentWriter& operator=(const SegmentWriter&) = delete;

  /// @returns false if the disk took nothing or not all of it; the file then ends with the record before
  bool append(const Record& record);
  void sync();
  /// Why append() failed last; empty if it did not.
  const std::string& error() const { return error_; }

 private:
  bool open_next();
  bool write_frame(const Record& record);
  void make_room(std::int64_t bytes);

  std::filesystem::path folder_;
  SegmentLogLimits limits_;
  Record settings_;
  std::int64_t number_ = 0;
  int file_ = -1;
  std::int64_t bytes_ = 0;
  std::string error_;
};

/// What was read of a log.
struct SegmentLogContents {
  std::vector<Record> records;       ///< in order of writing
  std::vector<std::string> damages;  ///< for people: file, place and size of what was skipped
};

/// Reads all files of a folder. Damage skips what it touches and is named; a torn last record is the usual end of a
/// killed process. @throws DataError if the folder holds no log or cannot be read
SegmentLogContents read_segments(const std::filesystem::path& folder);

}  // namespace alight
