#include "sensors/stream/fix_guard.hpp"

#include <cmath>
#include <utility>

#include "geometry/frames.hpp"
#include "geometry/geodesy.hpp"

namespace alight {
namespace {

/// Nobody lands at latitude 0, longitude 0, in the Atlantic; receivers without a position are there all the time.
bool is_null_island(const GeodeticPosition& fix) { return fix.latitude_deg == 0 && fix.longitude_deg == 0; }

}  // namespace

bool FixGuard::bears_out(const PositionSample& before, const PositionSample& now) {
  const auto& a = std::get<GeodeticPosition>(before.position);
  const auto& b = std::get<GeodeticPosition>(now.position);
  const double distance_m = LocalEnu(a.latitude_deg, a.longitude_deg, a.altitude_m)
                                .to_world(b.latitude_deg, b.longitude_deg, b.altitude_m)
                                .norm();
  const double flown_m = kMaxSpeed_mps * std::abs(to_seconds(now.t_ns - before.t_ns));
  return distance_m <= flown_m + kSlack_m;
}

std::vector<PositionSample> FixGuard::add(const PositionSample& sample) {
  const auto* fix = std::get_if<GeodeticPosition>(&sample.position);
  if (fix == nullptr) return {sample};  // metres of an odometry: its origin is anywhere
  if (is_null_island(*fix) || fix->sigma_m > kMaxSigma_m) {
    ++left_out_;
    return {};
  }
  if (last_ && bears_out(*last_, sample)) {
    left_out_ += static_cast<std::int64_t>(candidates_.size());
    candidates_.clear();
    last_ = sample;
    return {sample};
  }
  if (!candidates_.empty() && !bears_out(candidates_.back(), sample)) {
    left_out_ += static_cast<std::int64_t>(candidates_.size());
    candidates_.clear();
  }
  candidates_.push_back(sample);
  const std::size_t needed = last_ ? kAgreeing : 2;
  if (candidates_.size() < needed) return {};
  last_ = sample;
  return std::exchange(candidates_, {});
}

}  // namespace alight
