#include "sensors/messages/pose_decoders.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "tests/sensors/messages/decoding.hpp"

namespace alight::testing {
namespace {

using ::testing::HasSubstr;

const Eigen::Vector3d kPlace(1, 2, 3);
const Eigen::Quaterniond kLeftTurn(std::sqrt(0.5), 0, 0, std::sqrt(0.5));

DecodeOptions between(const std::string& world, const std::string& body) {
  DecodeOptions options;
  options.frames = {world, body};
  return options;
}

template <class Message>
void expect_the_pose(const Message& message) {
  const DecodeOptions options = between("world", "body");
  const auto attitude = decoded<AttitudeSample>(LogRole::kAttitude, message, options);
  EXPECT_EQ(attitude.t_ns, kStart_ns + 9);
  EXPECT_LT(attitude.q_world_imu.angularDistance(kLeftTurn), 1e-12);
  const auto position = decoded<PositionSample>(LogRole::kPosition, message, options);
  EXPECT_EQ(position.t_ns, kStart_ns + 9);
  EXPECT_EQ(std::get<Eigen::Vector3d>(position.position), kPlace);
}

TEST(PoseDecoders, EveryMessageOfAPoseGivesAttitudeAndPosition) {
  expect_the_pose(pose_message(kStart_ns + 9));
  expect_the_pose(odometry_message(kStart_ns + 9));
  expect_the_pose(transform_message(kStart_ns + 9));
  expect_the_pose(tf_message(kStart_ns + 9));
}

TEST(PoseDecoders, APointIsAPosition) {
  geometry_msgs::PointStamped message;
  message.header = header_at(kStart_ns);
  message.point.y = -4;
  const auto sample = decoded<PositionSample>(LogRole::kPosition, message);
  EXPECT_EQ(std::get<Eigen::Vector3d>(sample.position), Eigen::Vector3d(0, -4, 0));
  message.point.z = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error(LogRole::kPosition, message), HasSubstr("not finite"));
}

TEST(PoseDecoders, APositionNeedsNoAttitude) {
  geometry_msgs::PoseStamped message = pose_message(kStart_ns);
  message.pose.orientation = {};
  EXPECT_EQ(error(LogRole::kPosition, message), "");
  EXPECT_THAT(error(LogRole::kAttitude, message), HasSubstr("quaternion of length 0"));
}

TEST(PoseDecoders, ATransformTheOtherWayRoundIsInverted) {
  const DecodeOptions options = between("body", "world");
  const auto attitude = decoded<AttitudeSample>(LogRole::kAttitude, tf_message(kStart_ns), options);
  EXPECT_LT(attitude.q_world_imu.angularDistance(kLeftTurn.conjugate()), 1e-12);
  const auto position = decoded<PositionSample>(LogRole::kPosition, tf_message(kStart_ns), options);
  const Eigen::Vector3d p = std::get<Eigen::Vector3d>(position.position);
  EXPECT_LT((kLeftTurn * p + kPlace).norm(), 1e-12);
}

TEST(PoseDecoders, FramesMayBeginWithASlash) {
  EXPECT_EQ(error(LogRole::kAttitude, tf_message(kStart_ns), between("/world", "/body")), "");
  EXPECT_TRUE(decode(LogRole::kAttitude, "tf2_msgs/TFMessage", bytes_of(tf_message(kStart_ns)), 0,
                     between("/world", "body"))
                  .has_value());
}

TEST(PoseDecoders, TransformsOfOtherFramesAreNoMeasurementAndUnnamedOnesAnError) {
  EXPECT_FALSE(decode(LogRole::kAttitude, "tf2_msgs/TFMessage", bytes_of(tf_message(kStart_ns)), 0,
                      between("world", "camera"))
                   .has_value());
  EXPECT_THAT(error(LogRole::kPosition, tf_message(kStart_ns)), HasSubstr("log.tf_world_frame"));
  const std::vector<std::uint8_t> bytes = bytes_of(tf_message(kStart_ns));
  EXPECT_EQ(transform_frames({bytes.data(), bytes.size(), 0}),
            (std::vector<std::pair<std::string, std::string>>{
                {"world", "lidar"}, {"world", "body"}, {"world", "lidar"}}));
}

TEST(CameraInfoDecoder, GivesLensAndSize) {
  const auto description = decoded<CameraDescription>(LogRole::kCameraInfo, camera_info_message(kStart_ns));
  EXPECT_EQ(description.camera.intrinsics, (PinholeIntrinsics{44, 45, 31.5, 23.5, 64, 48}));
  EXPECT_EQ(description.camera.distortion_model, DistortionModel::kRadtan);
  EXPECT_EQ(description.camera.distortion_coeffs, (std::vector<double>{0.1, -0.02, 0.003, -0.004, 0.005}));
}

TEST(CameraInfoDecoder, KnowsTheModelsOfRosAndRefusesOthers) {
  sensor_msgs::CameraInfo message = camera_info_message(kStart_ns);
  message.distortion_model = "equidistant";
  EXPECT_THAT(error(LogRole::kCameraInfo, message), HasSubstr("5 coefficients of equidistant"));
  message.D.resize(4);
  EXPECT_EQ(decoded<CameraDescription>(LogRole::kCameraInfo, message).camera.distortion_model,
            DistortionModel::kEquidistant);
  message.distortion_model = "rational_polynomial";
  message.D = {1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(decoded<CameraDescription>(LogRole::kCameraInfo, message).camera.distortion_coeffs.size(), 8u);
  message.distortion_model = "omni";
  EXPECT_THAT(error(LogRole::kCameraInfo, message), HasSubstr("\"omni\""));
  message.D = {0, 0, 0, 0, 0};
  EXPECT_FALSE(decoded<CameraDescription>(LogRole::kCameraInfo, message).camera.has_distortion());
}

TEST(CameraInfoDecoder, AnUncalibratedCameraIsNoMeasurement) {
  sensor_msgs::CameraInfo message = camera_info_message(kStart_ns);
  message.K.fill(0);
  EXPECT_FALSE(decode(LogRole::kCameraInfo, "sensor_msgs/CameraInfo", bytes_of(message)).has_value());
}

}  // namespace
}  // namespace alight::testing
