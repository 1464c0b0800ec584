#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "sensors/messages/message_types.hpp"

namespace alight {

/// Judges the times of a LiDAR topic's points, for data sets and on board alike. A message holds what was measured since the
/// one before, or until the next: its points lie within one period of its stamp. The period is learnt from the stamps. A
/// counter that wrapped, or one that runs on from message to message, gives times that the vehicle's pose would
/// follow to a wrong place.
class PointTimeGuard {
 public:
  static constexpr std::int64_t kFirstReach_ns = 500'000'000;  ///< as long as no period is known
  static constexpr std::int64_t kMargin_ns = 10'000'000;
  static constexpr double kReachInPeriods = 1.25;  ///< stamps and periods jitter
  static constexpr double kMostOutside = 0.5;      ///< a message with more points outside is of no use

  /// Takes the points out whose times cannot be true. @returns how many
  /// @throws DecodeError if they are most of the points: what is left may be as wrong
  std::int64_t clean(LidarPacket& packet);

 private:
  void learn(std::int64_t stamp_ns);
  std::int64_t reach_ns() const;

  std::optional<std::int64_t> last_stamp_ns_;
  std::deque<std::int64_t> steps_ns_;  // between the latest stamps
};

}  // namespace alight
