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
    : queue_(queue),
      pipeline_(std::move(pipeline)),
      sinks_(std::move(sinks)),
      depth_thread_([this] { make_depth(); }),
      site_thread_([this] { make_sites(); }) {}

EngineRunner::~EngineRunner() {
  abandoned_ = true;
  queue_.close();
  stages_.abandon();
  for (std::thread* thread : {&depth_thread_, &site_thread_}) {
    if (thread->joinable()) thread->join();
  }
}

void EngineRunner::finish() {
  queue_.close();
  if (depth_thread_.joinable()) depth_thread_.join();
  stages_.close();
  if (site_thread_.joinable()) site_thread_.join();
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

void EngineRunner::make_depth() {
  try {
    while (auto item = queue_.pop()) {
      if (abandoned_) return;
      note_arrival(*item);
      const auto message = std::make_shared<const LogMessage>(std::move(item->message));
      stages_.push({message, {}, {}, {}});
      pass_on(pipeline_->depth().add(*message));
    }
    if (abandoned_) return;
    pass_on(pipeline_->depth().finish());
    stages_.push({{}, {}, {}, pipeline_->engine().dropped()});
  } catch (...) {
    fail(std::current_exception());
  }
}

void EngineRunner::note_arrival(const MessageQueue::Item& item) {
  if (const auto* frame = std::get_if<StereoFrame>(&item.message))
    arrivals_.emplace(frame->t_ns, item.pushed);
  // Images that are not believed get no result.
  while (arrivals_.size() > kMaxArrivals) arrivals_.erase(arrivals_.begin());
}

void EngineRunner::pass_on(std::vector<SensedDepth> depths) {
  StageEvent event;
  for (SensedDepth& sensed : depths) {
    std::optional<SteadyTime> arrived;
    if (const auto arrival = arrivals_.find(sensed.depth.t_ns); arrival != arrivals_.end()) {
      arrived = arrival->second;
      arrivals_.erase(arrival);
    }
    event.depths.push_back({std::move(sensed), arrived});
  }
  if (!event.depths.empty()) event.dropped = pipeline_->engine().dropped();
  if (!same_findings(pipeline_->health(), told_)) event.health = told_ = pipeline_->health();
  if (!event.depths.empty() || event.health) stages_.push(std::move(event));
}

void EngineRunner::make_sites() {
  try {
    while (auto event = stages_.pop()) deliver(std::move(*event));
  } catch (...) {
    fail(std::current_exception());
    stages_.abandon();
  }
}

void EngineRunner::deliver(StageEvent event) {
  if (event.message) {
    for (FrameSink* sink : sinks_) sink->on_message(*event.message);
  }
  for (StageEvent::Depth& depth : event.depths) {
    const FrameReport frame = pipeline_->sites().report(std::move(depth.sensed));
    for (FrameSink* sink : sinks_) sink->on_frame(frame);
    const std::lock_guard lock(mutex_);
    ++statistics_.images;
    if (depth.arrived) statistics_.count_latency(milliseconds(*depth.arrived, steady_now()));
  }
  if (event.dropped) {
    const std::lock_guard lock(mutex_);
    statistics_.dropped = std::move(*event.dropped);
  }
  if (event.health) {
    for (FrameSink* sink : sinks_) sink->on_health(*event.health);
  }
}

/// The first failure is the one that finish() tells.
void EngineRunner::fail(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
  queue_.close();
}

}  // namespace alight
