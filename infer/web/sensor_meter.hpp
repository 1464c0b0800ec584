#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "infer/onboard/steady_time.hpp"

namespace alight {

/// How often one kind of message comes, and when it came last.
class SensorMeter {
 public:
  void add(std::int64_t t_ns, SteadyTime arrival);

  std::int64_t count() const { return count_; }
  /// By the messages' own times over the last two seconds of them, so that an engine which takes them in bursts does not
  /// change it; 0 once nothing has come for so long.
  double rate_hz(SteadyTime now) const;
  /// Since the last message came, on this computer's clock; empty before the first.
  std::optional<double> age_s(SteadyTime now) const;

 private:
  std::deque<std::int64_t> times_ns_;  // of the last two seconds
  std::optional<SteadyTime> arrival_;
  std::int64_t count_ = 0;
};

}  // namespace alight
