#include "geometry/rig/point_timing.hpp"

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {

void bind_stamp(Binder& b, const std::string& key, StampSource& stamp) {
  b.choice(key, stamp, {{"header", StampSource::kHeader}, {"receive", StampSource::kReceive}},
           "time of a message: its header's stamp or when it was received");
}

void bind_point_timing(Binder& b, PointTiming& t) {
  using Unit = PointTiming::Unit;
  using Base = PointTiming::Base;
  using StampAt = PointTiming::StampAt;
  using Spread = PointTiming::Spread;
  b.field("point_time", t.field,
          "field of a point cloud that holds a point's time; auto: t, time, timestamp, offset_time or "
          "time_stamp, or time_sec with time_nsec; none: points have no time");
  b.choice("point_time_unit", t.unit,
           {{"auto", Unit::kAuto},
            {"s", Unit::kSeconds},
            {"ms", Unit::kMilliseconds},
            {"us", Unit::kMicroseconds},
            {"ns", Unit::kNanoseconds}},
           "of that field");
  b.choice(
      "point_time_base", t.base,
      {{"auto", Base::kAuto},
       {"relative", Base::kRelative},
       {"absolute", Base::kAbsolute},
       {"own_clock", Base::kOwnClock}},
      "since the begin of the scan, on the stamp's clock, or on one of its own of which only differences "
      "count");
  b.choice("stamp_at", t.stamp_at, {{"start", StampAt::kStart}, {"end", StampAt::kEnd}},
           "end of the scan at which the stamp is");
  b.field("scan_period_s", t.scan_period_s, "duration of a scan, needed where points have no time",
          at_least(0));
  b.choice("scan_spread", t.spread,
           {{"order", Spread::kOrder},
            {"clockwise", Spread::kClockwise},
            {"counterclockwise", Spread::kCounterclockwise}},
           "points without a time are measured in their order, or as the scanner turns (seen from above)");
  double start_deg = to_degrees(t.scan_start_rad);
  b.field("scan_start_deg", start_deg, "azimuth, from x to y, at which a turning scanner begins a scan");
  t.scan_start_rad = to_radians(start_deg);
}

}  // namespace alight
