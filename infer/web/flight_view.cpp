#include "infer/web/flight_view.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace alight {
namespace {

constexpr std::size_t kShownFrames = 8;       // a viewer may be so many frames late with its pictures
constexpr std::size_t kHistoryLength = 1200;  // a minute at 20 Hz

constexpr std::chrono::milliseconds kLookAgain{20};

// In the order of LogMessage.
constexpr const char* kSensors[] = {"image", "lidar", "attitude", "position", "height"};
static_assert(std::size(kSensors) == std::variant_size_v<LogMessage>);

}  // namespace

FlightView::FlightView(const FrameStyle& style, double max_rate_hz)
    : style_(style),
      period_(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double>(1.0 / max_rate_hz))),
      next_show_(steady_now()) {}

void FlightView::add(const LogMessage& message) {
  const std::int64_t t_ns = std::visit([](const auto& any) { return any.t_ns; }, message);
  arrivals_.push_back({message.index(), t_ns, steady_now()});
  hand_over();
}

void FlightView::add(const FrameReport& report) {
  results_to_come_.push_back({std::make_shared<const FrameReport>(report), steady_now()});
  hand_over();
}

void FlightView::hand_over() {
  std::vector<std::shared_ptr<const FrameReport>> unused;  // freed after the lock
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;
    for (const Arrival& arrival : arrivals_) meters_[arrival.sensor].add(arrival.t_ns, arrival.at);
    for (Result& result : results_to_come_) take(std::move(result));
    const auto shown = std::partition(retired_.begin(), retired_.end(),
                                      [](const auto& report) { return report.use_count() > 1; });
    unused.assign(std::make_move_iterator(shown), std::make_move_iterator(retired_.end()));
    retired_.erase(shown, retired_.end());
  }
  arrivals_.clear();
  results_to_come_.clear();
}

void FlightView::take(Result result) {
  const DepthResult& depth = result.report->depth;
  history_.push_back(
      {++results_, depth.t_ns, depth.source, depth.accumulation_s, depth.stereo, depth.holdout});
  if (history_.size() > kHistoryLength) history_.pop_front();
  if (latest_.report) retired_.push_back(std::move(latest_.report));
  latest_ = std::move(result);
}

std::shared_ptr<const ShownFrame> FlightView::wait(std::int64_t after, std::chrono::milliseconds timeout) {
  const SteadyTime deadline = steady_now() + timeout;
  std::unique_lock lock(mutex_);
  if (after > results_) after = 0;
  while (!closed_) {
    const bool newer = results_ > shown_number();
    const SteadyTime now = steady_now();
    // Also for a viewer who knows none: what was shown last may be from when somebody last looked.
    if (newer && now >= next_show_) return show_latest();
    if (shown_number() > after) return shown_.back();
    if (now >= deadline) break;
    // Results come without a call, see above.
    changed_.wait_until(lock, std::min(newer ? next_show_ : now + kLookAgain, deadline));
  }
  return shown_.empty() ? nullptr : shown_.back();
}

std::shared_ptr<const ShownFrame> FlightView::show_latest() {
  shown_.push_back(std::make_shared<ShownFrame>(results_, latest_.at, latest_.report, style_));
  if (shown_.size() > kShownFrames) shown_.pop_front();
  next_show_ = steady_now() + period_;
  changed_.notify_all();
  return shown_.back();
}

std::shared_ptr<const ShownFrame> FlightView::find(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  for (const auto& frame : shown_) {
    if (frame->number() == number) return frame;
  }
  return nullptr;
}

std::vector<HistorySample> FlightView::history(std::int64_t after, std::int64_t until) const {
  const std::lock_guard lock(mutex_);
  if (after > results_) after = 0;
  const auto up_to = [](std::int64_t number) {
    return [number](const HistorySample& sample) { return sample.number <= number; };
  };
  const auto first = std::partition_point(history_.begin(), history_.end(), up_to(after));
  return {first, std::partition_point(first, history_.end(), up_to(until))};
}

std::vector<SensorStatus> FlightView::sensors() const {
  std::vector<SensorStatus> sensors;
  const std::lock_guard lock(mutex_);
  const SteadyTime now = steady_now();
  for (std::size_t i = 0; i < meters_.size(); ++i)
    sensors.push_back({kSensors[i], meters_[i].count(), meters_[i].rate_hz(now), meters_[i].age_s(now)});
  return sensors;
}

void FlightView::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace alight
