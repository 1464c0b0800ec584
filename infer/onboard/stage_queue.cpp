#include "infer/onboard/stage_queue.hpp"

#include <utility>

namespace alight {

void StageQueue::push(StageEvent event) {
  {
    std::unique_lock lock(mutex_);
    if (!event.depths.empty()) changed_.wait(lock, [this] { return abandoned_ || depths_ < kMostDepths; });
    if (abandoned_) return;
    depths_ += event.depths.size();
    events_.push_back(std::move(event));
  }
  changed_.notify_all();
}

std::optional<StageEvent> StageQueue::pop() {
  std::optional<StageEvent> event;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || abandoned_ || !events_.empty(); });
    if (abandoned_ || events_.empty()) return std::nullopt;
    event = std::move(events_.front());
    events_.pop_front();
    depths_ -= event->depths.size();
  }
  changed_.notify_all();
  return event;
}

void StageQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

void StageQueue::abandon() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    events_.clear();
  }
  changed_.notify_all();
}

}  // namespace alight
