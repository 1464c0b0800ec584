#include "infer/web/flight_view.hpp"

#include <algorithm>
#include <utility>

namespace alight {
namespace {

constexpr std::size_t kShownFrames = 8;       // a viewer may be so many frames late with its pictures
constexpr std::size_t kHistoryLength = 1200;  // a minute at 20 Hz

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
  const SteadyTime now = steady_now();
  const std::lock_guard lock(mutex_);
  meters_[message.index()].add(t_ns, now);
}

void FlightView::add(const FrameReport& report) {
  auto latest = std::make_shared<const FrameReport>(report);
  const DepthResult& depth = report.depth;
  HistorySample sample{0, depth.t_ns, depth.source, depth.accumulation_s, depth.stereo, depth.holdout};
  const SteadyTime now = steady_now();
  bool due = false;
  {
    const std::lock_guard lock(mutex_);
    sample.number = ++results_;
    latest_.swap(latest);
    latest_at_ = now;
    due = now >= next_show_;
    history_.push_back(sample);
    if (history_.size() > kHistoryLength) history_.pop_front();
  }
  if (due) changed_.notify_all();
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
    changed_.wait_until(lock, newer ? std::min(next_show_, deadline) : deadline);
  }
  return shown_.empty() ? nullptr : shown_.back();
}

std::shared_ptr<const ShownFrame> FlightView::show_latest() {
  shown_.push_back(std::make_shared<ShownFrame>(results_, latest_at_, latest_, style_));
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
