#include "infer/autopilot/mavlink.hpp"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "infer/autopilot/mavlink_messages.hpp"

namespace alight {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A framer whose next frame has this number.
MavlinkFramer framer_at(int sequence, std::uint8_t system_id, std::uint8_t component_id) {
  MavlinkFramer framer(system_id, component_id);
  for (int i = 0; i < sequence; ++i) framer.frame(encode(Heartbeat{}));
  return framer;
}

// The frames below were packed by pymavlink 2.4.50 (dialect common, MAVLink 2) from the same fields.

TEST(MavlinkFramer, HeartbeatOfAnOnboardComputerIsPymavlinks) {
  EXPECT_EQ(framer_at(0, 1, 191).frame(encode(Heartbeat{})),
            (Bytes{0xFD, 0x09, 0x00, 0x00, 0x00, 0x01, 0xBF, 0x00, 0x00, 0x00, 0x00,
                   0x00, 0x00, 0x00, 0x12, 0x08, 0x00, 0x04, 0x03, 0xAE, 0xC6}));
}

TEST(MavlinkFramer, HeartbeatWithEveryFieldSetIsPymavlinks) {
  Heartbeat heartbeat;
  heartbeat.custom_mode = 0x01020304;
  heartbeat.type = 2;
  heartbeat.autopilot = 3;
  heartbeat.base_mode = 81;
  heartbeat.system_status = 3;
  EXPECT_EQ(framer_at(255, 42, 7).frame(encode(heartbeat)),
            (Bytes{0xFD, 0x09, 0x00, 0x00, 0xFF, 0x2A, 0x07, 0x00, 0x00, 0x00, 0x04,
                   0x03, 0x02, 0x01, 0x02, 0x03, 0x51, 0x03, 0x03, 0x62, 0x10}));
}

TEST(MavlinkFramer, LandingTargetWithPositionIsPymavlinks) {
  LandingTarget target;
  target.time_us = 1600000000123456;
  target.angle_x_rad = 0.125F;
  target.angle_y_rad = -0.25F;
  target.distance_m = 12.5F;
  target.size_x_rad = target.size_y_rad = 0.3125F;
  target.p_m = {1.5F, -2.25F, 12.0F};
  target.q_wxyz = {0.96875F, 0.125F, -0.1875F, 0.03125F};
  target.position_valid = 1;
  EXPECT_EQ(framer_at(17, 1, 191).frame(encode(target)),
            (Bytes{0xFD, 0x3C, 0x00, 0x00, 0x11, 0x01, 0xBF, 0x95, 0x00, 0x00, 0x40, 0xE2, 0xA5, 0x07, 0x31,
                   0xAF, 0x05, 0x00, 0x00, 0x00, 0x00, 0x3E, 0x00, 0x00, 0x80, 0xBE, 0x00, 0x00, 0x48, 0x41,
                   0x00, 0x00, 0xA0, 0x3E, 0x00, 0x00, 0xA0, 0x3E, 0x00, 0x0C, 0x00, 0x00, 0xC0, 0x3F, 0x00,
                   0x00, 0x10, 0xC0, 0x00, 0x00, 0x40, 0x41, 0x00, 0x00, 0x78, 0x3F, 0x00, 0x00, 0x00, 0x3E,
                   0x00, 0x00, 0x40, 0xBE, 0x00, 0x00, 0x00, 0x3D, 0x03, 0x01, 0xDC, 0x54}));
}

TEST(MavlinkFramer, ZerosAtTheEndAreLeftOutAsPymavlinkDoes) {
  LandingTarget target;
  target.time_us = 1000000;
  target.angle_x_rad = 0.5F;
  target.frame = 8;
  target.q_wxyz = {0, 0, 0, 0};
  target.type = 0;
  MavlinkFramer framer = framer_at(18, 1, 191);
  EXPECT_EQ(framer.frame(encode(target)),
            (Bytes{0xFD, 0x1E, 0x00, 0x00, 0x12, 0x01, 0xBF, 0x95, 0x00, 0x00, 0x40, 0x42, 0x0F, 0x00,
                   0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x3F, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                   0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x08, 0x12, 0x04}));
  target.time_us = 0;
  target.angle_x_rad = 0;
  target.frame = 0;
  EXPECT_EQ(framer.frame(encode(target)),
            (Bytes{0xFD, 0x01, 0x00, 0x00, 0x13, 0x01, 0xBF, 0x95, 0x00, 0x00, 0x00, 0x39, 0x46}));
}

TEST(MavlinkFramer, NumbersFramesModulo256) {
  MavlinkFramer framer = framer_at(255, 1, 191);
  EXPECT_EQ(framer.frame(encode(Heartbeat{}))[4], 255);
  EXPECT_EQ(framer.frame(encode(Heartbeat{}))[4], 0);
}

TEST(MavlinkFramer, MessageIdHasThreeBytes) {
  const Bytes frame = MavlinkFramer(1, 191).frame({0x010203, 0, {7}});
  EXPECT_EQ(Bytes(frame.begin() + 7, frame.begin() + 10), (Bytes{0x03, 0x02, 0x01}));
}

TEST(MavlinkFramer, RefusesWhatDoesNotFit) {
  MavlinkFramer framer(1, 191);
  EXPECT_EQ(framer.frame({1, 0, Bytes(255, 1)}).size(), 12U + 255U);
  EXPECT_THROW(framer.frame({1, 0, Bytes(256, 1)}), std::invalid_argument);
  EXPECT_THROW(framer.frame({0x1000000, 0, {1}}), std::invalid_argument);
}

TEST(MavlinkCrc, HasTheCatalogueCheckValueOfMcrf4xx) {
  const std::string digits = "12345678";
  EXPECT_EQ(mavlink_crc(reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size(), '9'), 0x6F91);
}

}  // namespace
}  // namespace alight
