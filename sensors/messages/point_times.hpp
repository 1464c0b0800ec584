#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "geometry/rig/point_timing.hpp"

/// From what a LiDAR's driver says of its points' times to int64 nanoseconds (PointTiming).
namespace alight {

/// The stamp of one scan.
struct ScanStamp {
  std::int64_t header_ns = 0;  ///< as the driver wrote it
  std::int64_t chosen_ns = 0;  ///< that one or the receive time, as configured
  bool is_header = true;
};

/// What the messages of a topic said of their points' times so far. A unit is told by how long a scan is; a cloud that lost
/// most of its points is short, and would be taken for another unit.
struct PointTimeMemory {
  double longest = 0;  ///< number in the time field of any cloud so far
};

/// Stands for a time that is not finite.
constexpr std::int64_t kNoTime_ns = std::numeric_limits<std::int64_t>::min();

/// The time to which offsets since the begin of the scan are added: the stamp, or so much before it that the last point
/// (at `scan_period_s`, else at `longest_ns`) is at the stamp.
std::int64_t scan_begin_ns(std::int64_t stamp_ns, const PointTiming& timing, std::int64_t longest_ns);

/// What a time field is made of. Only double numbers hold times since 1970 to less than a second.
enum class TimeNumber { kWhole, kSingle, kDouble };

/// The time of each point from its value in the cloud's time field; values that are not finite take no part.
/// @param memory of the topic; null: this message is judged alone. @throws DecodeError that names the key of the rig
/// file where unit or base cannot be told
std::vector<std::int64_t> times_of_values(const std::vector<double>& values, TimeNumber number,
                                          const PointTiming& timing, const ScanStamp& stamp,
                                          PointTimeMemory* memory = nullptr);

/// The time of each point of a cloud that has no time field. @throws DecodeError where no scan_period_s is configured
std::vector<std::int64_t> spread_times(const std::vector<Eigen::Vector3f>& points, const PointTiming& timing,
                                       const ScanStamp& stamp);

}  // namespace alight
