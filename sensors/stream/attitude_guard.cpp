#include "sensors/stream/attitude_guard.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "geometry/frames.hpp"
#include "sensors/messages/byte_reader.hpp"

namespace alight {

void AttitudeGuard::check(const AttitudeSample& sample) {
  const std::int64_t before_ns = last_ns_.value_or(sample.t_ns);
  if (last_ns_ && sample.t_ns <= *last_ns_) return;  // out of order: others tell
  last_ns_ = sample.t_ns;
  check_steps(sample.t_ns - before_ns);
  if (!sample.rate_rad_s) return;
  if (sample.q_world_imu.angularDistance(began_) > kStood_rad) {
    began_ = sample.q_world_imu;
    turned_rad_ = 0;
  }
  turned_rad_ += *sample.rate_rad_s * std::min(to_seconds(sample.t_ns - before_ns), 0.1);
  if (turned_rad_ < kTurned_rad) return;
  throw DecodeError(fmt::format(
      "the orientation stands still while the message's own gyroscope has turned by {:.0f} deg: this IMU "
      "estimates none; name another topic in log.attitude_topic",
      to_degrees(turned_rad_)));
}

void AttitudeGuard::check_steps(std::int64_t step_ns) {
  if (step_ns <= 0) return;
  steps_ns_.push_back(step_ns);
  if (steps_ns_.size() > kSteps) steps_ns_.pop_front();
  if (steps_ns_.size() == kSteps) {
    const double mean_ns =
        static_cast<double>(std::accumulate(steps_ns_.begin(), steps_ns_.end(), std::int64_t{0})) / kSteps;
    const auto shorter = std::count_if(steps_ns_.begin(), steps_ns_.end(), [&](std::int64_t step) {
      return static_cast<double>(step) < kShortStep * mean_ns;
    });
    const auto gaps = static_cast<std::int64_t>(kSteps) - shorter;
    const double gap_ns = mean_ns * kSteps / static_cast<double>(std::max<std::int64_t>(gaps, 1));
    in_bursts_ =
        2 * shorter > static_cast<std::int64_t>(kSteps) && gap_ns > static_cast<double>(kHarmlessGap_ns);
  }
  if (!in_bursts_) return;
  throw DecodeError(
      "stamps come in bursts: most are within a fifth of the usual step of the one before, then there is "
      "none for "
      "a while. They tell when a buffer was emptied and not when the attitudes were; let the driver stamp "
      "them by "
      "its device's clock, or record another topic");
}

}  // namespace alight
