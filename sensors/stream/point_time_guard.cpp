#include "sensors/stream/point_time_guard.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "sensors/messages/byte_reader.hpp"

namespace alight {
namespace {

constexpr std::size_t kSteps = 9;
/// Slower than any LiDAR: a pause.
constexpr std::int64_t kLongestStep_ns = 2 * kNanosecondsPerSecond;

}  // namespace

void PointTimeGuard::learn(std::int64_t stamp_ns) {
  const std::int64_t step_ns = last_stamp_ns_ ? stamp_ns - *last_stamp_ns_ : 0;
  last_stamp_ns_ = stamp_ns;
  if (step_ns <= 0 || step_ns > kLongestStep_ns) return;  // twice the same message, or a pause
  steps_ns_.push_back(step_ns);
  if (steps_ns_.size() > kSteps) steps_ns_.pop_front();
}

std::int64_t PointTimeGuard::reach_ns() const {
  if (steps_ns_.empty()) return kFirstReach_ns;
  const std::int64_t period_ns = median(std::vector<std::int64_t>(steps_ns_.begin(), steps_ns_.end()));
  return std::max(static_cast<std::int64_t>(kReachInPeriods * static_cast<double>(period_ns)),
                  period_ns + kMargin_ns);
}

std::int64_t PointTimeGuard::clean(LidarPacket& packet) {
  learn(packet.t_ns);
  const std::int64_t reach = reach_ns();
  const auto count = static_cast<std::int64_t>(packet.returns.size());
  std::int64_t farthest_ns = 0;
  const auto outside = [&](const LidarReturn& point) {
    const std::int64_t from_stamp_ns = point.t_ns - packet.t_ns;
    if (std::abs(from_stamp_ns) <= reach) return false;
    if (std::abs(from_stamp_ns) > std::abs(farthest_ns)) farthest_ns = from_stamp_ns;
    return true;
  };
  const auto end = std::remove_if(packet.returns.begin(), packet.returns.end(), outside);
  packet.returns.erase(end, packet.returns.end());
  const std::int64_t removed = count - static_cast<std::int64_t>(packet.returns.size());
  if (static_cast<double>(removed) > kMostOutside * static_cast<double>(count)) {
    throw DecodeError(fmt::format(
        "{} of {} points have times up to {:.3f} s from the message's stamp, though messages come "
        "every {:.3f} s: the driver's times cannot be true; check point_time, point_time_unit "
        "and point_time_base of the rig's lidar0, or the driver's version",
        removed, count, to_seconds(farthest_ns), to_seconds(reach) / kReachInPeriods));
  }
  return removed;
}

}  // namespace alight
