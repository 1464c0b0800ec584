#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "foundation/errors.hpp"
#include "sensors/messages/decoders.hpp"

namespace alight {

/// Receive time minus header stamp over the messages of a topic: how late messages come, and how far clocks are apart.
struct StampDelay {
  double median_s = 0;
  double min_s = 0;
  double max_s = 0;
};

/// What a role's decoder made of the first messages of a topic.
struct RoleTrial {
  LogRole role = LogRole::kImage;
  int tried = 0;
  int measurements = 0;       ///< messages that decode and hold something
  std::string first_problem;  ///< of the others; empty: none
  std::optional<DecodedMessage> example;
  bool needs_scan_period = false;  ///< its points have no time of their own
};

/// One topic (of one message type) of a bag.
struct TopicReport {
  std::string topic;
  std::string type;
  std::string md5;
  std::int64_t messages = 0;
  std::int64_t first_ns = 0;  ///< receive times
  std::int64_t last_ns = 0;
  double longest_gap_s = 0;                              ///< between messages that follow one another
  std::int64_t longest_gap_ns = 0;                       ///< receive time of the message before it
  std::int64_t gaps = 0;                                 ///< longer than three times the median
  std::optional<StampDelay> offset;                      ///< none: the type has no header
  bool known_type = false;                               ///< a decoder has its name
  bool known_version = false;                            ///< and its checksum
  std::vector<RoleTrial> roles;                          ///< what it could serve as
  std::set<std::pair<std::string, std::string>> frames;  ///< of transforms: (parent, child)

  double rate_hz() const;  ///< 0 with less than two messages
  /// The trial of a role that gave a measurement; null: it cannot serve as that.
  const RoleTrial* serves_as(LogRole role) const;
};

/// What a bag holds, topic by topic.
struct BagReport {
  std::filesystem::path path;
  std::int64_t messages = 0;
  std::int64_t begin_ns = 0;  ///< receive times; 0 without messages
  std::int64_t end_ns = 0;
  std::vector<TopicReport> topics;  ///< by name
  std::uint64_t lost_bytes = 0;     ///< at the end of a bag without index
  /// Messages that the index has and that have no time, so that no tool reads them: topic -> count.
  std::map<std::string, std::int64_t> without_time;
};

/// Reads a bag once, whatever is in it; a bag without messages is one, too.
/// @throws DataError if the file is missing, empty, cut off or damaged
BagReport inspect_bag(const std::filesystem::path& path);

}  // namespace alight
