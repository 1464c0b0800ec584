#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/steady_time.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// Something that happened to the depth stage: a message is about to be worked on, or was.
struct StageEvent {
  struct Depth {
    SensedDepth sensed;
    std::optional<SteadyTime> arrived;  ///< its image, in the queue of messages
  };
  std::shared_ptr<const LogMessage> message;  ///< about to be worked on; null otherwise
  std::vector<Depth> depths;                  ///< became final
  std::optional<HealthReport> health;         ///< has other findings than before
  /// DepthEngine::dropped() so far; with depths and at the end.
  std::optional<std::map<std::string, std::int64_t>> dropped;
};

/// From the depth stage to the site stage: nothing is lost. Whoever brings depth waits while that of `kMostDepths` images
/// is not worked off yet, so that what does not fit is pushed out of the queue of messages, where it is counted.
class StageQueue {
 public:
  static constexpr std::size_t kMostDepths = 2;

  void push(StageEvent event);
  /// Waits for an event. @returns nothing once the queue is closed and empty, or abandoned
  std::optional<StageEvent> pop();
  /// Nothing more comes.
  void close();
  /// Nothing more is wanted: what waits is lost, and nobody waits any more.
  void abandon();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<StageEvent> events_;
  std::size_t depths_ = 0;  // in events_
  bool closed_ = false;
  bool abandoned_ = false;
};

}  // namespace alight
