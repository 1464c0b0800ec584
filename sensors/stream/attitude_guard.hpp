#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Geometry>

#include "sensors/messages/message_types.hpp"

namespace alight {

/// Notices attitudes that cannot be those of their times, for data sets and on board alike. Every LiDAR point is placed by
/// them, so that a driver's mistake bends the ground without a word:
/// - an IMU that estimates no orientation writes the same one for ever, while its own gyroscope turns;
/// - a driver that stamps when a buffer is emptied gives many attitudes nearly one time, then none for a while.
class AttitudeGuard {
 public:
  static constexpr double kTurned_rad = 0.35;  ///< by the gyroscope, 20 degrees
  static constexpr double kStood_rad = 0.02;   ///< by the orientation meanwhile
  static constexpr std::size_t kSteps = 100;   ///< between stamps, that are looked at together
  static constexpr double kShortStep = 0.2;    ///< of the mean step; most are shorter in bursts
  static constexpr std::int64_t kHarmlessGap_ns = 30'000'000;

  /// @throws DecodeError that says what is wrong with the topic
  void check(const AttitudeSample& sample);

 private:
  void check_steps(std::int64_t step_ns);

  std::optional<std::int64_t> last_ns_;
  Eigen::Quaterniond began_ = Eigen::Quaterniond::Identity();  // the orientation since it was that
  double turned_rad_ = 0;                                      // by the gyroscope since then
  std::deque<std::int64_t> steps_ns_;
  bool in_bursts_ = false;
};

}  // namespace alight
