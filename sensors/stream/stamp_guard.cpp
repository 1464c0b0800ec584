#include "sensors/stream/stamp_guard.hpp"

#include <cmath>
#include <cstdlib>

namespace alight {

bool StampGuard::follows(const Times& before, const Times& now) {
  const std::int64_t stamp_step_ns = now.stamp_ns - before.stamp_ns;
  const std::int64_t receive_step_ns = now.receive_ns - before.receive_ns;
  const bool regular = stamp_step_ns >= 0 && stamp_step_ns <= kMaxJump_ns;
  return regular || std::abs(stamp_step_ns - receive_step_ns) <= kMaxJump_ns;
}

bool StampGuard::usable(std::int64_t stamp_ns, std::int64_t receive_ns) {
  const Times now{stamp_ns, receive_ns};
  if (!last_ || follows(*last_, now)) {
    last_ = now;
    last_jump_.reset();
    agreeing_ = 0;
    return true;
  }
  agreeing_ = last_jump_ && follows(*last_jump_, now) ? agreeing_ + 1 : 1;
  last_jump_ = now;
  if (agreeing_ < kAgreeing) return false;
  last_ = now;
  last_jump_.reset();
  agreeing_ = 0;
  return true;
}

}  // namespace alight
