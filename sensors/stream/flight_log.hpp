#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "foundation/errors.hpp"
#include "geometry/rig/rig.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/stream/log_config.hpp"

namespace alight {

/// What was read, and what was left out and why.
struct LogSummary {
  std::int64_t begin_ns = 0;  ///< receive time of the first message
  std::int64_t end_ns = 0;
  std::int64_t messages = 0;                           ///< on the topics that are read
  std::map<std::string, std::int64_t> topic_messages;  ///< the same by topic
  std::map<std::string, std::int64_t> dropped;         ///< reason -> count; grows while reading
};

/// A ROS 1 bag as typed messages in the order in which they were recorded, with the rig's time shifts applied and left
/// and right images paired (MessageAssembler). The same order is what an onboard program would have seen, so replay and
/// data set building share this class.
class FlightLog {
 public:
  /// @throws DataError if the file is missing, empty, truncated or damaged, if a needed topic (images, LiDAR,
  /// attitude, position) is not in it or has a type without decoder; the message names file and topic.
  /// @throws ConfigError if the rig names no topic for a camera or LiDAR.
  FlightLog(const std::filesystem::path& path, const Rig& rig, const LogConfig& config);
  /// Reads `topics` alone (such as those of a rig that stands still and has no poses).
  FlightLog(const std::filesystem::path& path, const Rig& rig, const LogConfig& config,
            const std::vector<SensorTopic>& topics);
  ~FlightLog();
  FlightLog(FlightLog&&) noexcept;
  FlightLog& operator=(FlightLog&&) noexcept;

  /// Only every n-th frame is decoded and handed on, the others are counted as dropped.
  void keep_every_nth_image(int n);
  /// From now on frames come undecoded: whoever takes them calls `decode`, on whatever thread.
  void put_off_decoding();
  /// Fills the images of a frame whose decoding was put off. @throws DecodeError
  void decode(StereoFrame& frame) const;

  /// The next message; false at the end. Messages that do not decode are counted, logged with their place,
  /// skipped.
  /// @throws DataError past max_bad_message_share, or if the bag turns out damaged
  bool next(LogMessage& out);

  /// When the recorder received the message that `next` returned last (the later camera of a stereo frame).
  std::int64_t receive_ns() const;
  /// Messages of the bag consumed so far, of summary().messages; for progress bars.
  std::int64_t consumed() const;
  const LogSummary& summary() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alight
