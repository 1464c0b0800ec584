#include "infer/onboard/message_queue.hpp"

#include <algorithm>
#include <utility>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

enum Kind { kImage, kPacket, kOther };
constexpr const char* kReasons[] = {"image pushed out of the queue: the engine is too slow",
                                    "LiDAR packet pushed out of the queue: the engine is too slow",
                                    "pose message pushed out of the queue: the engine is too slow"};

Kind kind_of(const LogMessage& message) {
  if (std::holds_alternative<StereoFrame>(message)) return kImage;
  if (std::holds_alternative<LidarPacket>(message)) return kPacket;
  return kOther;
}

}  // namespace

void bind(Binder& b, MessageQueueConfig& c) {
  b.field("max_images", c.max_images,
          "images that may wait for the engine; the oldest goes when another comes", between(1, 1000));
  b.field("max_packets", c.max_packets, "LiDAR packets that may wait, as above", between(1, 100000));
  b.field("max_others", c.max_others, "attitudes, positions and heights that may wait, as above",
          between(1, 1000000));
}

void MessageQueue::push(LogMessage message) {
  const Kind kind = kind_of(message);
  const int limits[] = {config_.max_images, config_.max_packets, config_.max_others};
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    if (waiting_[kind] == limits[kind]) {
      const auto oldest = std::find_if(items_.begin(), items_.end(),
                                       [&](const Item& item) { return kind_of(item.message) == kind; });
      items_.erase(oldest);
      --waiting_[kind];
      ++dropped_[kReasons[kind]];
    }
    items_.push_back({std::move(message), steady_now()});
    ++waiting_[kind];
  }
  changed_.notify_one();
}

std::optional<MessageQueue::Item> MessageQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || !items_.empty(); });
  if (items_.empty()) return std::nullopt;
  Item item = std::move(items_.front());
  items_.pop_front();
  --waiting_[kind_of(item.message)];
  return item;
}

void MessageQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

std::size_t MessageQueue::size() const {
  const std::lock_guard lock(mutex_);
  return items_.size();
}

std::map<std::string, std::int64_t> MessageQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace alight
