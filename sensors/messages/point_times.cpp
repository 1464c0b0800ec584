#include "sensors/messages/point_times.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "geometry/frames.hpp"
#include "sensors/messages/byte_reader.hpp"

namespace alight {
namespace {

using Unit = PointTiming::Unit;
using Base = PointTiming::Base;

constexpr double kLongestScan_ns = 10e9;
constexpr double kOneDay_ns = 86'400e9;
/// 1973: clocks that count from power-on stay below.
constexpr double kEarliestAbsolute_ns = 1e17;
constexpr Unit kUnits[] = {Unit::kSeconds, Unit::kMilliseconds, Unit::kMicroseconds, Unit::kNanoseconds};

double nanoseconds_per(Unit unit) {
  switch (unit) {
    case Unit::kSeconds:
      return 1e9;
    case Unit::kMilliseconds:
      return 1e6;
    case Unit::kMicroseconds:
      return 1e3;
    case Unit::kAuto:
    case Unit::kNanoseconds:
      break;
  }
  return 1;
}

struct Extent {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double longest() const { return std::max(std::abs(min), std::abs(max)); }
};

Extent extent_of(const std::vector<double>& values) {
  Extent extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    extent.min = std::min(extent.min, value);
    extent.max = std::max(extent.max, value);
  }
  return extent;
}

/// The unit in which `value` is a time of the day of the stamp; at most one is.
std::optional<Unit> absolute_unit(double value, Unit configured, const ScanStamp& stamp) {
  for (const Unit unit : kUnits) {
    if (configured != Unit::kAuto && configured != unit) continue;
    const double t_ns = value * nanoseconds_per(unit);
    if (t_ns > kEarliestAbsolute_ns && std::abs(t_ns - static_cast<double>(stamp.header_ns)) < kOneDay_ns)
      return unit;
  }
  return std::nullopt;
}

/// Scans last from a millisecond to a few seconds, whose numbers do not overlap in s, us and ns.
std::optional<Unit> relative_unit(double longest, TimeNumber number) {
  if (number != TimeNumber::kWhole && longest >= 1e-3 && longest <= 2) return Unit::kSeconds;
  if (longest >= 2e3 && longest <= 1e6) return Unit::kMicroseconds;
  if (longest >= 5e6 && longest <= 5e9) return Unit::kNanoseconds;
  return std::nullopt;
}

[[noreturn]] void fail_unclear(const Extent& extent, const std::string& cure) {
  throw DecodeError("point times from " + std::to_string(extent.min) + " to " + std::to_string(extent.max) +
                    ": " + cure);
}

struct Meaning {
  Unit unit;
  Base base;
};

Meaning meaning_of(const Extent& extent, TimeNumber number, const PointTiming& timing, const ScanStamp& stamp,
                   PointTimeMemory* memory) {
  Meaning meaning{timing.unit, timing.base};
  if (number == TimeNumber::kSingle && absolute_unit(extent.max, meaning.unit, stamp)) {
    fail_unclear(
        extent,
        "absolute times, which float32 cannot hold (its steps are up to 128 s); let the driver write "
        "float64, or set point_time: none and scan_period_s of the rig's lidar0");
  }
  if (meaning.base == Base::kAuto || (meaning.base == Base::kAbsolute && meaning.unit == Unit::kAuto)) {
    const auto unit =
        number == TimeNumber::kDouble ? absolute_unit(extent.max, meaning.unit, stamp) : std::nullopt;
    if (!unit && meaning.base == Base::kAbsolute) {
      fail_unclear(extent,
                   "no double numbers, or in no unit on the day of the stamp; set point_time_unit (s, ms, "
                   "us, ns) of the rig's "
                   "lidar0, or point_time_base to relative or own_clock");
    }
    meaning = unit ? Meaning{*unit, Base::kAbsolute} : Meaning{meaning.unit, Base::kRelative};
  }
  if (meaning.unit != Unit::kAuto) return meaning;
  double longest = meaning.base == Base::kOwnClock ? extent.max - extent.min : extent.longest();
  if (memory != nullptr) longest = memory->longest = std::max(memory->longest, longest);
  const auto unit = relative_unit(longest, number);
  if (!unit) {
    fail_unclear(extent,
                 "the unit cannot be told; set point_time_unit (s, ms, us, ns) of the rig's lidar0, or "
                 "point_time: none if the field means nothing");
  }
  return {*unit, meaning.base};
}

/// The scan's azimuth clockwise or counterclockwise from where it begins, 0 .. 1.
double turned_share(const Eigen::Vector3f& point, const PointTiming& timing) {
  constexpr double kTurn_rad = 2 * 180.0 * kRadiansPerDegree;
  const double azimuth_rad = std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x()));
  const double turn_rad = azimuth_rad - timing.scan_start_rad;
  const double share = (timing.spread == PointTiming::Spread::kClockwise ? -turn_rad : turn_rad) / kTurn_rad;
  return share - std::floor(share);
}

}  // namespace

std::int64_t scan_begin_ns(std::int64_t stamp_ns, const PointTiming& timing, std::int64_t longest_ns) {
  if (timing.stamp_at == PointTiming::StampAt::kStart) return stamp_ns;
  return stamp_ns - (timing.scan_period_s ? to_nanoseconds(*timing.scan_period_s) : longest_ns);
}

std::vector<std::int64_t> times_of_values(const std::vector<double>& values, TimeNumber number,
                                          const PointTiming& timing, const ScanStamp& stamp,
                                          PointTimeMemory* memory) {
  const Extent extent = extent_of(values);
  if (extent.min > extent.max) return std::vector<std::int64_t>(values.size(), kNoTime_ns);
  Meaning meaning = meaning_of(extent, number, timing, stamp, memory);
  if (meaning.base == Base::kAbsolute && !stamp.is_header) meaning.base = Base::kOwnClock;
  const double unit_ns = nanoseconds_per(meaning.unit);
  const double longest_ns =
      unit_ns * (meaning.base == Base::kRelative ? extent.longest() : extent.max - extent.min);
  if (longest_ns > kLongestScan_ns) {
    fail_unclear(extent,
                 "span more than 10 s; check point_time_unit and point_time_base of the rig's lidar0");
  }
  double zero = 0;  // the value that stands for the origin
  std::int64_t origin_ns = 0;
  if (meaning.base == Base::kRelative && extent.min < 0 && extent.max <= 0) {
    origin_ns = stamp.chosen_ns;  // negative times count back from the stamp, whichever end it is said to be
  } else if (meaning.base == Base::kRelative) {
    origin_ns = scan_begin_ns(stamp.chosen_ns, timing, std::llround(extent.max * unit_ns));
  } else if (meaning.base == Base::kOwnClock) {
    zero = timing.stamp_at == PointTiming::StampAt::kStart ? extent.min : extent.max;
    origin_ns = stamp.chosen_ns;
  }
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(values.size());
  for (const double value : values) {
    times_ns.push_back(std::isfinite(value) ? origin_ns + std::llround((value - zero) * unit_ns)
                                            : kNoTime_ns);
  }
  return times_ns;
}

std::vector<std::int64_t> spread_times(const std::vector<Eigen::Vector3f>& points, const PointTiming& timing,
                                       const ScanStamp& stamp) {
  if (!timing.scan_period_s) {
    throw DecodeError(
        "points have no time of their own; set scan_period_s of the rig's lidar0 (0: all points at the "
        "stamp), or point_time to the name of the field that holds it");
  }
  const double period_ns = *timing.scan_period_s * 1e9;
  const std::int64_t begin_ns = scan_begin_ns(stamp.chosen_ns, timing, 0);
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool in_order = timing.spread == PointTiming::Spread::kOrder;
    const double share = in_order                ? static_cast<double>(i) / static_cast<double>(points.size())
                         : points[i].allFinite() ? turned_share(points[i], timing)
                                                 : 0;
    times_ns.push_back(begin_ns + std::llround(share * period_ns));
  }
  return times_ns;
}

}  // namespace alight
