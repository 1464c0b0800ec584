#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"
#include "infer/onboard/steady_time.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// How much may wait for the engine.
struct MessageQueueConfig {
  int max_images = 2;     ///< stereo pairs; the oldest goes when another comes
  int max_packets = 50;   ///< LiDAR packets, as above
  int max_others = 2000;  ///< attitudes, positions and heights, as above
};
void bind(Binder& b, MessageQueueConfig& c);

/// From the threads that receive messages to the one that works on them: first in, first out, bounded. An engine that
/// does not keep up loses the oldest images and goes on with the newest, and the loss is counted; the small messages
/// behind which it could lose its place in the world have room for seconds.
class MessageQueue {
 public:
  struct Item {
    LogMessage message;
    SteadyTime pushed;  ///< when it came
  };

  explicit MessageQueue(const MessageQueueConfig& config) : config_(config) {}

  /// Never waits. After close() nothing is taken any more.
  void push(LogMessage message);
  /// Waits for a message. @returns nothing once the queue is closed and empty
  std::optional<Item> pop();
  void close();

  std::size_t size() const;
  /// What was pushed out: reason -> count.
  std::map<std::string, std::int64_t> dropped() const;

 private:
  MessageQueueConfig config_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  std::array<int, 3> waiting_{};  // images, packets, others
  std::map<std::string, std::int64_t> dropped_;
  bool closed_ = false;
};

}  // namespace alight
