#pragma once

#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// Which of a message's two times is taken for it.
enum class StampSource {
  kHeader,   ///< the one its driver wrote
  kReceive,  ///< the one at which the recorder or node got it, for drivers whose clock is not to be trusted
};

/// How the LiDAR points of one message come by their own times. The defaults are those of the Livox driver, and detect
/// what a point cloud's time field means where that is unambiguous.
struct PointTiming {
  enum class Unit { kAuto, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
  enum class Base {
    kAuto,      ///< absolute if the times are near the message's stamp in some unit, else relative
    kRelative,  ///< since the begin of the scan
    kAbsolute,  ///< on the clock of the stamp
    kOwnClock,  ///< on a clock of their own: only their differences count
  };
  enum class StampAt { kStart, kEnd };  ///< of the scan
  /// How points without a time of their own are spread over the scan: in their order, or by their azimuth.
  enum class Spread { kOrder, kClockwise, kCounterclockwise };

  std::string field =
      "auto";  ///< of a point cloud; auto: whichever of the known names it has; none: it has none
  Unit unit = Unit::kAuto;
  Base base = Base::kAuto;
  StampAt stamp_at = StampAt::kStart;
  std::optional<double> scan_period_s;  ///< needed where points have no time; 0: all points at the stamp
  Spread spread = Spread::kOrder;
  double scan_start_rad = 0;  ///< azimuth at which a scan begins, from x (forward) to y (left)
};

/// The key that chooses between the two times.
void bind_stamp(Binder& b, const std::string& key, StampSource& stamp);
/// The keys of a rig's LiDAR that tell the times of its points.
void bind_point_timing(Binder& b, PointTiming& timing);

}  // namespace alight
