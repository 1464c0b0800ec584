#include "infer/onboard/engine_runner.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace alight {
namespace {

constexpr std::size_t kMaxArrivals = 1000;

}  // namespace

void RunnerStatistics::count_latency(double latency_ms) {
  last_latency_ms = latency_ms;
  max_latency_ms = std::max(max_latency_ms, latency_ms);
  ++latencies[std::min(static_cast<std::size_t>(latency_ms), kLatencySteps - 1)];
}

double RunnerStatistics::latency_ms(double share) const {
  const auto counted = std::accumulate(latencies.begin(), latencies.end(), std::int64_t{0});
  std::int64_t below = 0;
  for (std::size_t i = 0; i < latencies.size(); ++i) {
    below += latencies[i];
    if (counted > 0 && static_cast<double>(below) >= share * static_cast<double>(counted))
      return std::min(static_cast<double>(i + 1), max_latency_ms);
  }
  return 0;
}

EngineRunner::EngineRunner(const MessageQueueConfig& queue, std::unique_ptr<LandingPipeline> pipeline,
                           std::vector<FrameSink*> sinks)
    : queue_(queue), pipeline_(std::move(pipeline)), sinks_(std::move(sinks)), thread_([this] { run(); }) {}

EngineRunner::~EngineRunner() {
  abandoned_ = true;
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void EngineRunner::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

bool EngineRunner::failed() const {
  const std::lock_guard lock(mutex_);
  return failure_ != nullptr;
}

RunnerStatistics EngineRunner::statistics() const {
  RunnerStatistics statistics;
  {
    const std::lock_guard lock(mutex_);
    statistics = statistics_;
  }
  for (const auto& [reason, count] : queue_.dropped()) statistics.dropped[reason] += count;
  statistics.queued = queue_.size();
  return statistics;
}

void EngineRunner::run() {
  try {
    while (auto item = queue_.pop()) {
      if (abandoned_) return;
      note_arrival(*item);
      for (FrameSink* sink : sinks_) sink->on_message(item->message);
      deliver(pipeline_->add(item->message));
      tell_health();
    }
    if (!abandoned_) deliver(pipeline_->finish());
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    queue_.close();
  }
}

void EngineRunner::tell_health() {
  if (same_findings(pipeline_->health(), told_)) return;
  told_ = pipeline_->health();
  for (FrameSink* sink : sinks_) sink->on_health(told_);
}

void EngineRunner::note_arrival(const MessageQueue::Item& item) {
  if (const auto* frame = std::get_if<StereoFrame>(&item.message))
    arrivals_.emplace(frame->t_ns, item.pushed);
  // Images that are not believed get no result.
  while (arrivals_.size() > kMaxArrivals) arrivals_.erase(arrivals_.begin());
}

void EngineRunner::deliver(const std::vector<FrameReport>& frames) {
  for (const FrameReport& frame : frames) {
    for (FrameSink* sink : sinks_) sink->on_frame(frame);
    const std::lock_guard lock(mutex_);
    ++statistics_.images;
    if (const auto arrival = arrivals_.find(frame.depth.t_ns); arrival != arrivals_.end()) {
      statistics_.count_latency(milliseconds(arrival->second, steady_now()));
      arrivals_.erase(arrival);
    }
  }
  const std::lock_guard lock(mutex_);
  statistics_.dropped = pipeline_->engine().dropped();
}

}  // namespace alight
