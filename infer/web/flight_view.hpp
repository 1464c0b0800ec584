#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "infer/web/sensor_meter.hpp"
#include "infer/web/shown_frame.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// What the charts show of one result.
struct HistorySample {
  std::int64_t number = 0;  ///< of the result, from 1
  std::int64_t t_ns = 0;
  DepthSource source = DepthSource::kNone;
  double accumulation_s = 0;
  StereoScores stereo;
  HoldoutScores holdout;
};

/// Rate and age of one sensor's messages.
struct SensorStatus {
  std::string name;  ///< "image", "lidar", "attitude", "position", "height"
  std::int64_t count = 0;
  double rate_hz = 0;
  std::optional<double> age_s;
};

/// What viewers see of a flight: the latest result, the history of the scores, the sensors' rates.
///
/// The engine's thread puts things in, and must not wait for viewers: their threads have the lowest priority, and one
/// that holds a lock may not run for a tenth of a second. So add() only tries the lock; what it cannot hand over goes
/// with the next message. It wakes nobody (a condition variable makes the waker wait for those woken before), and images
/// are freed on the engine's thread, out of reach of a viewer that stops inside the allocator.
class FlightView {
 public:
  /// @param max_rate_hz a new frame is chosen for showing at most so often, however many viewers ask
  FlightView(const FrameStyle& style, double max_rate_hz);

  /// Both from one thread, the engine's.
  void add(const LogMessage& message);
  void add(const FrameReport& report);

  /// Waits for a frame whose number is larger than `after`. @returns after the timeout the one shown last, which may be
  /// null. A number larger than all there were counts as 0: the viewer knew another flight.
  std::shared_ptr<const ShownFrame> wait(std::int64_t after, std::chrono::milliseconds timeout);
  /// One of the last few that wait() returned, else null.
  std::shared_ptr<const ShownFrame> find(std::int64_t number) const;
  /// The results with after < number <= until, the last minute's at most.
  std::vector<HistorySample> history(std::int64_t after, std::int64_t until) const;
  std::vector<SensorStatus> sensors() const;
  /// Nobody waits any more.
  void close();

 private:
  struct Arrival {
    std::size_t sensor = 0;
    std::int64_t t_ns = 0;
    SteadyTime at;
  };
  struct Result {
    std::shared_ptr<const FrameReport> report;
    SteadyTime at;
  };

  void hand_over();
  // With the mutex held.
  void take(Result result);
  std::shared_ptr<const ShownFrame> show_latest();
  std::int64_t shown_number() const { return shown_.empty() ? 0 : shown_.back()->number(); }

  FrameStyle style_;
  std::chrono::steady_clock::duration period_;
  // The engine's thread alone: what is not handed over yet.
  std::vector<Arrival> arrivals_;
  std::vector<Result> results_to_come_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool closed_ = false;
  std::int64_t results_ = 0;
  Result latest_;                                            // number results_
  std::vector<std::shared_ptr<const FrameReport>> retired_;  // once latest_; perhaps still shown
  SteadyTime next_show_;
  std::deque<std::shared_ptr<const ShownFrame>> shown_;  // the last few
  std::deque<HistorySample> history_;
  std::array<SensorMeter, std::variant_size_v<LogMessage>> meters_;
};

}  // namespace alight
