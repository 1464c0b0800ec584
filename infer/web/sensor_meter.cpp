#include "infer/web/sensor_meter.hpp"

namespace alight {
namespace {

constexpr double kWindow_s = 2;
constexpr std::int64_t kWindow_ns = 2'000'000'000;
constexpr std::size_t kMaxTimes = 4096;  // whatever the stamps say

}  // namespace

void SensorMeter::add(std::int64_t t_ns, SteadyTime arrival) {
  ++count_;
  arrival_ = arrival;
  if (!times_ns_.empty() && t_ns < times_ns_.back()) times_ns_.clear();  // a clock that jumped back
  times_ns_.push_back(t_ns);
  while (t_ns - times_ns_.front() > kWindow_ns || times_ns_.size() > kMaxTimes) times_ns_.pop_front();
}

double SensorMeter::rate_hz(SteadyTime now) const {
  if (times_ns_.size() < 2 || age_s(now) > kWindow_s) return 0;
  const auto span_ns = static_cast<double>(times_ns_.back() - times_ns_.front());
  return span_ns > 0 ? static_cast<double>(times_ns_.size() - 1) * 1e9 / span_ns : 0;
}

std::optional<double> SensorMeter::age_s(SteadyTime now) const {
  if (!arrival_) return std::nullopt;
  return milliseconds(*arrival_, now) * 1e-3;
}

}  // namespace alight
