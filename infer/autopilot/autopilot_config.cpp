#include "infer/autopilot/autopilot_config.hpp"

#include "foundation/config_reader.hpp"
#include "infer/autopilot/transport.hpp"

namespace alight {

void bind(Binder& b, AutopilotConfig& c) {
  b.field("connection", c.connection, "udp:host:port or serial:device:baud; none: nothing is sent");
  b.check("connection", !c.connection || parse_connection(*c.connection),
          "expected udp:host:port, such as udp:192.168.1.2:14550, or serial:device:baud with a usual baud "
          "rate, such "
          "as serial:/dev/ttyTHS1:921600");
  b.field("system_id", c.system_id, "MAVLink system id of the vehicle", between(1, 255));
  b.field("component_id", c.component_id, "MAVLink component id of this program", between(1, 255));
  b.field("max_rate_hz", c.max_rate_hz, "landing targets a second", between(1, 100));
  b.field("max_age_s", c.max_age_s, "a landing site whose image is older is not sent", between(0.05, 10));
}

}  // namespace alight
