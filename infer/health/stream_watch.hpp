#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "infer/health/symptom.hpp"

namespace alight {

/// The sensors as streams of stamped messages.
enum class Stream { kCamera, kLidar, kAttitude, kPosition, kHeight };
constexpr int kStreams = 5;
/// As HealthFinding::sensor.
const char* sensor_name(Stream stream);

/// What time it is, told by the messages alone: the second latest of the streams' latest stamps. So one stream whose
/// clock jumps ahead does not move it, and one that jumps back or falls silent does not hold it.
class MessageClock {
 public:
  void saw(Stream stream, std::int64_t t_ns);
  std::optional<std::int64_t> now_ns() const;

 private:
  std::array<std::optional<std::int64_t>, kStreams> latest_ns_;
};

/// Whether one sensor's messages come at all, in order, and on the common clock.
class StreamWatch {
 public:
  /// @param needed whether a flight without this sensor is a finding. Others are missed once they have spoken.
  StreamWatch(const HealthConfig& config, Stream stream, bool needed);

  /// A message has come. @param now_ns the common clock's. @param slack_s how far apart the messages lie that set it
  /// @returns whether its stamp is to be believed
  bool add(std::int64_t t_ns, std::int64_t now_ns, double slack_s);
  /// Time goes on, with messages or without. @param begin_ns of the flight
  void pass(std::int64_t now_ns, std::int64_t begin_ns);

  /// Lost, or on a wrong clock: nothing of it can be used.
  bool usable() const { return !lost_.present() && !clock_.present(); }
  bool lost() const { return lost_.present(); }
  bool clock_jumped() const { return clock_.present(); }
  void report(std::vector<HealthFinding>& findings) const;
  /// Between two messages, as they usually come; 0: not known yet.
  double period_s() const;

 private:
  void note_order(std::int64_t t_ns, std::int64_t now_ns);

  HealthConfig config_;
  bool needed_;
  std::optional<std::int64_t> last_ns_;      // believed
  std::optional<std::int64_t> previous_ns_;  // of any
  std::deque<std::int64_t> gaps_ns_;
  std::deque<bool> late_;
  Symptom lost_;
  Symptom clock_;
  Symptom order_;
};

}  // namespace alight
