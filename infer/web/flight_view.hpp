#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dataset/messages/message_types.hpp"
#include "infer/web/sensor_meter.hpp"
#include "infer/web/shown_frame.hpp"

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

/// What viewers see of a flight: the latest result, the history of the scores, the sensors' rates. The engine's thread
/// puts things in and never waits for more than the copying of a few pointers; viewers' threads take them out.
class FlightView {
 public:
  /// @param max_rate_hz a new frame is chosen for showing at most so often, however many viewers ask
  FlightView(const FrameStyle& style, double max_rate_hz);

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
  // Both with the mutex held.
  std::shared_ptr<const ShownFrame> show_latest();
  std::int64_t shown_number() const { return shown_.empty() ? 0 : shown_.back()->number(); }

  FrameStyle style_;
  std::chrono::steady_clock::duration period_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool closed_ = false;
  std::int64_t results_ = 0;
  std::shared_ptr<const FrameReport> latest_;  // result number results_
  SteadyTime latest_at_;
  SteadyTime next_show_;
  std::deque<std::shared_ptr<const ShownFrame>> shown_;  // the last few
  std::deque<HistorySample> history_;
  std::array<SensorMeter, std::variant_size_v<LogMessage>> meters_;
};

}  // namespace alight
