#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/messages/message_types.hpp"

namespace alight {

/// Tells satellite fixes that cannot be true from the others, for data sets and on board alike. A receiver without its
/// position gives latitude and longitude 0, the place of yesterday, or one that leaps, and its driver may call that a fix. A fix
/// counts once another one bears it out: the same place, but for what a vehicle flies in between. So the first fix of
/// a flight, at which the world has its origin, waits for the second. Where the following fixes agree on another
/// place, they are taken.
class FixGuard {
 public:
  static constexpr double kMaxSpeed_mps = 60;
  static constexpr double kSlack_m = 10;  ///< fixes scatter
  static constexpr int kAgreeing = 5;     ///< in a row make a leap the truth
  static constexpr double kMaxSigma_m = 50;

  /// @returns those that count from now on, in the order in which they came: none, this one, or one that waited and this one
  std::vector<PositionSample> add(const PositionSample& sample);
  /// Of those that were given and did not come back, or never will.
  std::int64_t left_out() const { return left_out_; }

 private:
  static bool bears_out(const PositionSample& before, const PositionSample& now);

  std::optional<PositionSample> last_;      // that counted
  std::vector<PositionSample> candidates_;  // in a row, each borne out by the next
  std::int64_t left_out_ = 0;
};

}  // namespace alight
