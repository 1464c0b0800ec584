#pragma once

#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// How landing sites are sent to the autopilot. Section `autopilot` of the inference configuration.
struct AutopilotConfig {
  /// udp:host:port or serial:device:baud, as parse_connection reads it; empty: nothing is sent.
  std::optional<std::string> connection;
  int system_id = 1;        ///< the vehicle's (ArduPilot SYSID_THISMAV or MAV_SYSID, PX4 MAV_SYS_ID)
  int component_id = 191;   ///< this program's; 191 is MAV_COMP_ID_ONBOARD_COMPUTER
  double max_rate_hz = 10;  ///< landing targets a second; heartbeats come on top
  double max_age_s = 0.5;   ///< a landing site whose image is older is not sent
};
/// Checks `connection` too.
void bind(Binder& b, AutopilotConfig& c);

}  // namespace alight
