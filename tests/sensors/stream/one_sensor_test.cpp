#include "sensors/stream/one_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/messages/byte_reader.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

LidarPacket packet(std::optional<int> lidar_id, const std::string& frame_id) {
  LidarPacket out;
  out.lidar_id = lidar_id;
  out.frame_id = frame_id;
  return out;
}

TEST(OneSensor, TwoIdsOnATopicAskForAChoice) {
  OneSensor one(std::nullopt);
  EXPECT_TRUE(one.wanted(packet(0, "livox")));
  EXPECT_TRUE(one.wanted(packet(0, "livox")));
  EXPECT_THAT(
      testing::message_of<DecodeError>([&] { one.wanted(packet(1, "livox")); }),
      AllOf(HasSubstr("lidar_id 1"), HasSubstr("lidar_id 0"), HasSubstr("set lidar_id of the rig's lidar0")));
}

TEST(OneSensor, TheChosenOneIsTakenWhateverComesFirst) {
  OneSensor one(1);
  EXPECT_FALSE(one.wanted(packet(0, "left")));
  EXPECT_TRUE(one.wanted(packet(1, "right")));
  EXPECT_FALSE(one.wanted(packet(0, "left")));
}

TEST(OneSensor, WithoutAnIdTheFrameTells) {
  OneSensor one(std::nullopt);
  EXPECT_TRUE(one.wanted(packet({}, "front")));
  EXPECT_THAT(testing::message_of<DecodeError>([&] { one.wanted(packet({}, "rear")); }),
              AllOf(HasSubstr("\"rear\""), HasSubstr("\"front\"")));
}

}  // namespace
}  // namespace alight
