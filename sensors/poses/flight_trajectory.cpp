#include "sensors/poses/flight_trajectory.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "geometry/frames.hpp"

namespace alight {

bool FlightTrajectory::add(const PositionSample& sample) {
  return trajectory_.add_position(sample.t_ns, world_.to_world(sample));
}

void HeightTrack::add(const HeightSample& sample) {
  if (samples_.empty() || sample.t_ns > samples_.back().t_ns) samples_.push_back(sample);
}

double HeightTrack::at(std::int64_t t_ns) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t_ns,
                                      [](const HeightSample& s, std::int64_t t) { return s.t_ns < t; });
  if (after == samples_.end()) return kNone;
  if (after->t_ns == t_ns) return after->height_m;
  if (after == samples_.begin()) return kNone;
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->t_ns - before->t_ns;
  if (gap_ns > kNanosecondsPerSecond) return kNone;
  const double share = static_cast<double>(t_ns - before->t_ns) / static_cast<double>(gap_ns);
  return before->height_m + share * (after->height_m - before->height_m);
}

double HeightTrack::at_or_latest(std::int64_t t_ns, std::int64_t max_age_ns) const {
  const bool latest =
      !samples_.empty() && samples_.back().t_ns < t_ns && t_ns - samples_.back().t_ns <= max_age_ns;
  return latest ? samples_.back().height_m : at(t_ns);
}

void HeightTrack::forget_before(std::int64_t t_ns) {
  while (samples_.size() > 1 && samples_[1].t_ns <= t_ns) samples_.pop_front();
}

}  // namespace alight
