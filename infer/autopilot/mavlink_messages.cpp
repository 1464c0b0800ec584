#include "infer/autopilot/mavlink_messages.hpp"

namespace alight {

MavlinkMessage encode(const Heartbeat& heartbeat) {
  MavlinkFields fields;
  fields.put(heartbeat.custom_mode)
      .put(heartbeat.type)
      .put(heartbeat.autopilot)
      .put(heartbeat.base_mode)
      .put(heartbeat.system_status)
      .put(heartbeat.mavlink_version);
  return {0, 50, fields.bytes()};
}

MavlinkMessage encode(const LandingTarget& target) {
  MavlinkFields fields;
  fields.put(target.time_us)
      .put(target.angle_x_rad)
      .put(target.angle_y_rad)
      .put(target.distance_m)
      .put(target.size_x_rad)
      .put(target.size_y_rad)
      .put(target.target_num)
      .put(target.frame);
  // MAVLink 2's extension fields: never reordered, not part of crc_extra.
  for (const float coordinate_m : target.p_m) fields.put(coordinate_m);
  for (const float component : target.q_wxyz) fields.put(component);
  fields.put(target.type).put(target.position_valid);
  return {149, 200, fields.bytes()};
}

}  // namespace alight
