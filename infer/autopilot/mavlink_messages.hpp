#pragma once

#include <array>
#include <cstdint>

#include "infer/autopilot/mavlink.hpp"

namespace alight {

/// HEARTBEAT, message 0: who is there.
struct Heartbeat {
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 18;      ///< MAV_TYPE_ONBOARD_CONTROLLER
  std::uint8_t autopilot = 8;  ///< MAV_AUTOPILOT_INVALID: this component is none
  std::uint8_t base_mode = 0;
  std::uint8_t system_status = 4;    ///< MAV_STATE_ACTIVE
  std::uint8_t mavlink_version = 3;  ///< of the message set; the same for MAVLink 1 and 2
};
MavlinkMessage encode(const Heartbeat& heartbeat);

/// LANDING_TARGET, message 149: where to land. Fields of MAVLink's `common` message set.
struct LandingTarget {
  std::uint64_t time_us = 0;
  float angle_x_rad = 0;  ///< off the image's centre, to the image's right
  float angle_y_rad = 0;  ///< off the image's centre, to the image's lower edge
  float distance_m = 0;   ///< from the vehicle
  float size_x_rad = 0;
  float size_y_rad = 0;
  std::uint8_t target_num = 0;
  std::uint8_t frame = 12;                     ///< MAV_FRAME_BODY_FRD: x forward, y right, z down
  std::array<float, 3> p_m = {0, 0, 0};        ///< in `frame`
  std::array<float, 4> q_wxyz = {1, 0, 0, 0};  ///< the target's orientation in `frame`
  std::uint8_t type = 3;                       ///< LANDING_TARGET_TYPE_VISION_OTHER
  std::uint8_t position_valid = 0;             ///< 1: p_m, q_wxyz and type may be used
};
MavlinkMessage encode(const LandingTarget& target);

}  // namespace alight
