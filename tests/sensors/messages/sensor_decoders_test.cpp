#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/messages/decoders.hpp"
#include "tests/sensors/messages/decoding.hpp"

namespace alight::testing {
namespace {

using ::testing::HasSubstr;

TEST(LivoxDecoder, EveryPointHasItsOwnTime) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 3);
  message.timebase = 5;  // the sensor's own clock must not matter
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, message);
  ASSERT_EQ(packet.returns.size(), 3u);
  EXPECT_EQ(packet.t_ns, kStart_ns);
  EXPECT_EQ(packet.returns[2].t_ns, kStart_ns + message.points[2].offset_time);
  EXPECT_EQ(packet.returns[2].p_lidar,
            Eigen::Vector3f(message.points[2].x, message.points[2].y, message.points[2].z));
  EXPECT_EQ(packet.returns[2].reflectivity, 2);
}

TEST(LivoxDecoder, DropsAndCountsWhatIsNoEcho) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 6);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  message.points[0].x = message.points[0].y = message.points[0].z = 0;
  message.points[1].y = nan;
  message.points[2].x = inf;
  message.points[3].x = 1000;
  message.points[4].x = 0.1F;
  message.points[4].y = message.points[4].z = 0;
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, message);
  EXPECT_EQ(packet.returns.size(), 1u);
  EXPECT_EQ(packet.dropped, 5);
}

TEST(LivoxDecoder, CountsThatLieAreRefused) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 3);
  message.point_num = 4;
  EXPECT_THAT(error(LogRole::kLidar, message), HasSubstr("point_num is 4, but 3 points follow"));
  std::vector<std::uint8_t> bytes = bytes_of(livox_message(kStart_ns, 0));
  const std::uint32_t huge = 0xFFFFFFFF;  // both counts agree on 80 GB
  std::memcpy(bytes.data() + bytes.size() - 4, &huge, 4);
  std::memcpy(bytes.data() + bytes.size() - 12, &huge, 4);
  EXPECT_THAT(message_of<DecodeError>([&] { decode(LogRole::kLidar, "livox_ros_driver/CustomMsg", bytes); }),
              HasSubstr("4294967295 points announced, but 0 bytes"));
}

TEST(QuaternionDecoder, NormalisesAndRefusesTheZeroQuaternion) {
  geometry_msgs::QuaternionStamped message = attitude_message(kStart_ns);
  message.quaternion.w = 0.8;
  message.quaternion.z = 0.6001;
  const auto sample = decoded<AttitudeSample>(LogRole::kAttitude, message);
  EXPECT_NEAR(sample.q_world_imu.norm(), 1, 1e-15);
  EXPECT_NEAR(sample.q_world_imu.z(), 0.6, 1e-3);
  message.quaternion.w = message.quaternion.z = 0;
  EXPECT_THAT(error(LogRole::kAttitude, message), HasSubstr("quaternion of length 0"));
  message.quaternion.w = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error(LogRole::kAttitude, message), "");
}

TEST(ImuDecoder, GivesItsOrientation) {
  sensor_msgs::Imu message;
  message.header = header_at(kStart_ns + 3);
  message.orientation.x = 1;
  message.angular_velocity.x = 9;
  const auto sample = decoded<AttitudeSample>(LogRole::kAttitude, message);
  EXPECT_EQ(sample.t_ns, kStart_ns + 3);
  EXPECT_EQ(sample.q_world_imu.x(), 1);
  message.orientation_covariance[0] = -1;  // "no orientation" in sensor_msgs/Imu
  EXPECT_FALSE(decode(LogRole::kAttitude, "sensor_msgs/Imu", bytes_of(message)).has_value());
}

TEST(FixDecoder, GivesThePositionUnlessThereIsNoFix) {
  sensor_msgs::NavSatFix message = fix_message(kStart_ns);
  const auto sample = decoded<PositionSample>(LogRole::kPosition, message);
  const auto& fix = std::get<GeodeticPosition>(sample.position);
  EXPECT_EQ(fix.latitude_deg, message.latitude);
  EXPECT_EQ(fix.longitude_deg, message.longitude);
  EXPECT_EQ(fix.altitude_m, message.altitude);
  message.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_FALSE(decode(LogRole::kPosition, "sensor_msgs/NavSatFix", bytes_of(message)).has_value());
  message.status.status = 0;
  message.latitude = 91;
  EXPECT_THAT(error(LogRole::kPosition, message), HasSubstr("latitude 91"));
  message.latitude = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error(LogRole::kPosition, message), "");
}

TEST(HeightDecoder, TakesTheReceiveTime) {
  const auto result = decode(LogRole::kHeight, "std_msgs/Float32", bytes_of(float_message(12.5F)), 42);
  const auto sample = std::get<HeightSample>(result.value());
  EXPECT_EQ(sample.t_ns, 42);
  EXPECT_EQ(sample.height_m, 12.5);
  EXPECT_NE(error(LogRole::kHeight, float_message(std::numeric_limits<float>::quiet_NaN())), "");
}

TEST(Stamps, TheReceiveTimeCountsWhereTheConfigurationSaysSo) {
  DecodeOptions options;
  options.stamp = StampSource::kReceive;
  const std::int64_t receive_ns = kStart_ns + 5'000'000;
  EXPECT_EQ(
      decoded<AttitudeSample>(LogRole::kAttitude, attitude_message(kStart_ns), options, receive_ns).t_ns,
      receive_ns);
  EXPECT_EQ(
      decoded<PositionSample>(LogRole::kPosition, odometry_message(kStart_ns), options, receive_ns).t_ns,
      receive_ns);
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, image_message(7, 4, 4, "mono8"), options, receive_ns).t_ns,
            receive_ns);
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, livox_message(12'345, 3), options, receive_ns);
  EXPECT_EQ(packet.returns[1].t_ns, receive_ns + livox_message(0, 3).points[1].offset_time);
}

TEST(HeaderReading, RefusesAStampWithTooManyNanoseconds) {
  std::vector<std::uint8_t> bytes = bytes_of(attitude_message(kStart_ns));
  const std::uint32_t too_many = 1'000'000'000;
  std::memcpy(bytes.data() + 8, &too_many, 4);
  EXPECT_THAT(
      message_of<DecodeError>([&] { decode(LogRole::kAttitude, "geometry_msgs/QuaternionStamped", bytes); }),
      HasSubstr("stamp"));
}

}  // namespace
}  // namespace alight::testing
