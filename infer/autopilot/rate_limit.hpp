#pragma once

#include <chrono>
#include <optional>

#include "infer/onboard/steady_time.hpp"

namespace alight {

/// Lets through no more than `max_rate_hz` in the long run. What comes at that very rate with some jitter passes: the
/// next one is due a period after the last was due, not after it came.
class RateLimit {
 public:
  explicit RateLimit(double max_rate_hz)
      : period_(std::chrono::duration_cast<SteadyTime::duration>(
            std::chrono::duration<double>(1 / max_rate_hz))) {}

  bool allow(SteadyTime now) {
    if (due_ && now < *due_) return false;
    due_ = (due_ && now < *due_ + period_ ? *due_ : now) + period_;
    return true;
  }

 private:
  SteadyTime::duration period_;
  std::optional<SteadyTime> due_;
};

}  // namespace alight
